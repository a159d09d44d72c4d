/* settings.h - everything about a pack that a person may choose, in one place: one line of the table per setting.
 *
 * The table is what the configuration file may say, what `footfall-pack config` prints, what stands in the pack's
 * provenance and what the cache asks about. To add a setting: a member in stage_settings.h, a line in settings.c. */
#ifndef FF_SETTINGS_H
#define FF_SETTINGS_H

#include "preprocess/base/stage_settings.h"
#include "runtime/tool/json.h"

enum { FF_SETTING_PATH = 1024 }; /* bytes of a path, with its end */

typedef struct ff_settings {
    struct {
        char skeleton[FF_SETTING_PATH];
    } rig;
    ff_find_settings find;
    ff_cut_settings cut;
    ff_correspondence_settings correspondences;
    ff_successor_settings successors;
    ff_actions_settings actions;
    ff_poses_settings poses;
    ff_skin_settings skin;
} ff_settings;

/* The earliest stage whose result a setting changes: what a cache holds of later stages is then made anew. */
typedef enum ff_setting_stage {
    FF_STAGE_FIND, /* one clip by itself: plants */
    FF_STAGE_CUT,  /* one clip on the pack's skeleton: motion, actions, cycles */
    FF_STAGE_PACK  /* all clips together */
} ff_setting_stage;

typedef enum ff_setting_kind {
    FF_SETTING_NUMBER,
    FF_SETTING_WHOLE,
    FF_SETTING_SWITCH,
    FF_SETTING_FILE
} ff_setting_kind;

typedef struct ff_setting {
    const char *section, *key; /* "poses", "rate": {"poses": {"rate": 60}} */
    ff_setting_kind kind;
    ff_setting_stage stage;
    const char *unit;           /* "Hz"; "" for a plain number or switch */
    double standard, low, high; /* default and range; of a switch 0 or 1; of a file 0: none by default */
    const char *what;           /* one line for people */
    size_t place; /* in ff_settings: double, int64_t, bool or char[FF_SETTING_PATH] ("" = none) */
} ff_setting;

extern const ff_setting ff_setting_table[];
extern const int ff_setting_count;

ff_settings ff_settings_default(void);

/* Set *out from a configuration: {"section": {"key": value}}, what is absent keeps its default. Keys that begin with
 * "//" are comments (strings). Files are named relative to the folder of path or name. Everything else that is unknown,
 * of another type or out of range is refused with its place. */
ff_status ff_settings_load(const char *path, ff_settings *out, ff_error *error);
ff_status ff_settings_parse(const char *text, size_t size, const char *name, ff_settings *out,
                            ff_error *error);

/* Of a file 1 when there is one. */
double ff_setting_value(const ff_settings *settings, const ff_setting *setting);

/* The settings of one section after the other, as an object, files without their folders; NULL when memory is short. */
json_t *ff_settings_json(const ff_settings *settings);

/* XXH64 over the values of every setting of the stages up to this one, going on from seed. Files do not count: what is in
 * them does, for whoever uses it. */
uint64_t ff_settings_hash(const ff_settings *settings, ff_setting_stage up_to, uint64_t seed);

/* footfall-pack config: print the reference, a configuration with every setting at its default and a comment. */
int ff_config_command(int argc, char **argv);

#endif
