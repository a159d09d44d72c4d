#include "preprocess/build/settings.h"

#include "runtime/tool/command_line.h"

#include <stdio.h>
#include <string.h>

static void print_value(const ff_setting *setting, double value)
{
    if (setting->kind == FF_SETTING_FILE)
        printf("\"\"");
    else if (setting->kind == FF_SETTING_SWITCH)
        printf("%s", value != 0.0 ? "true" : "false");
    else
        printf("%.10g", value);
}

static void print_setting(const ff_setting *setting, bool last)
{
    printf("    \"// %s\": \"", setting->key);
    if (setting->kind == FF_SETTING_FILE)
        printf("a file, relative to this one's folder, or \\\"\\\" for none");
    else if (setting->kind == FF_SETTING_SWITCH)
        printf("true or false");
    else
        printf("%s%s%.10g to %.10g", setting->unit, *setting->unit ? ", " : "", setting->low, setting->high);
    printf(": %s\",\n    \"%s\": ", setting->what, setting->key);
    print_value(setting, setting->standard);
    printf("%s\n", last ? "" : ",");
}

static void print_reference(void)
{
    printf("{\n  \"//\": \"Every setting of footfall-pack build --config, at its default; keys with // are "
           "comments\"");
    for (int i = 0; i < ff_setting_count; ++i) {
        const ff_setting *s = &ff_setting_table[i];
        bool first = i == 0 || strcmp(s->section, s[-1].section) != 0;
        bool last = i + 1 == ff_setting_count || strcmp(s->section, s[1].section) != 0;
        if (first) printf(",\n\n  \"%s\": {\n", s->section);
        print_setting(s, last);
        if (last) printf("  }");
    }
    printf("\n}\n");
}

int ff_config_command(int argc, char **argv)
{
    ff_option options[] = {{0}};
    ff_command command = {
        .program = "footfall-pack",
        .name = "config",
        .arguments = "",
        .summary = "print every setting of build: unit, range, default",
        .details = "What is printed is itself a configuration: change what you want and give it to "
                   "'footfall-pack build --config FILE'.\n"
                   "What a configuration leaves out keeps its default.",
        .options = options,
    };
    ff_operands operands;
    int result = ff_command_parse(&command, argc, argv, &operands);
    if (result >= 0) return result;
    print_reference();
    return FF_EXIT_OK;
}
