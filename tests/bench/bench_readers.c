/* How fast motion text becomes clips: MB/s of AMC and of BVH on one core, beside strtod over the same bytes. Real clips
 * when the outside data is there, made-up text of the same kind when it is not. */
#define _GNU_SOURCE
#include "mocap/print.h"
#include "mocap/read.h"
#include "runtime/core/base/file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { ROUNDS = 9, BONES = 30, FRAMES = 3000 };

static double seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now); /* of this one core, whatever else the machine does */
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

typedef struct text {
    char *data; /* ends in a NUL, so that strtod may run over it */
    size_t size;
} text;

static text text_of(const char *data, size_t size)
{
    text copy = {malloc(size + 1), size};
    if (!copy.data) return (text){NULL, 0};
    memcpy(copy.data, data, size);
    copy.data[size] = '\0';
    return copy;
}

static text text_of_file(const char *folder, const char *name)
{
    char path[1024];
    ff_file file;
    snprintf(path, sizeof path, "%s/data/cmu/%s", folder, name);
    if (ff_file_map(path, &file, NULL) != FF_OK) return (text){NULL, 0};
    text copy = text_of(file.data, file.size);
    ff_file_unmap(&file);
    return copy;
}

static text text_of_print(ff_print *print)
{
    text copy = print->failed ? (text){NULL, 0} : text_of(print->bytes.data, print->bytes.count);
    ff_array_free(&print->bytes);
    return copy;
}

static void print_bone_name(ff_print *print, int bone)
{
    ff_print_text(print, bone == 0 ? "root" : "bone");
    if (bone > 0) ff_print_integer(print, bone);
}

static double angle(int frame, int bone, int axis)
{
    return 60.0 * ff_sin(0.02 * frame + 0.7 * bone + 2.1 * axis);
}

static text made_up_asf(void)
{
    ff_print print = {0};
    ff_print_text(&print, ":units\n length 0.45\n angle deg\n:root\n order TX TY TZ RX RY RZ\n axis XYZ\n"
                          " position 0 0 0\n orientation 0 0 0\n:bonedata\n");
    for (int b = 1; b < BONES; ++b) {
        ff_print_text(&print, "begin\n name ");
        print_bone_name(&print, b);
        ff_print_text(&print, "\n direction 0 1 0\n length 1\n axis 0 0 20 XYZ\n dof rx ry rz\nend\n");
    }
    ff_print_text(&print, ":hierarchy\nbegin\n");
    for (int b = 0; b + 1 < BONES; ++b) {
        print_bone_name(&print, b);
        ff_print_text(&print, " ");
        print_bone_name(&print, b + 1);
        ff_print_text(&print, "\n");
    }
    ff_print_text(&print, "end\n");
    return text_of_print(&print);
}

static text made_up_amc(void)
{
    ff_print print = {0};
    ff_print_text(&print, ":FULLY-SPECIFIED\n:DEGREES\n");
    for (int frame = 0; frame < FRAMES; ++frame) {
        ff_print_integer(&print, frame + 1);
        ff_print_text(&print, "\n");
        for (int b = 0; b < BONES; ++b) {
            print_bone_name(&print, b);
            if (b == 0) ff_print_text(&print, " 1.5 17.25 -30.125");
            ff_print_vec3(&print, ff_v3(angle(frame, b, 0), angle(frame, b, 1), angle(frame, b, 2)), 5);
            ff_print_text(&print, "\n");
        }
    }
    return text_of_print(&print);
}

static text made_up_bvh(void)
{
    ff_print print = {0};
    ff_print_text(&print, "HIERARCHY\n");
    for (int b = 0; b < BONES; ++b)
        ff_print_text(&print,
                      b == 0 ? "ROOT hips\n{\nOFFSET 0 0 0\nCHANNELS 6 Xposition Yposition Zposition "
                               "Zrotation Yrotation Xrotation\n"
                             : "JOINT bone\n{\nOFFSET 0 1 0\nCHANNELS 3 Zrotation Yrotation Xrotation\n");
    ff_print_repeat(&print, "}\n", BONES);
    ff_print_text(&print, "MOTION\nFrames: ");
    ff_print_integer(&print, FRAMES);
    ff_print_text(&print, "\nFrame Time: 0.0083333\n");
    for (int frame = 0; frame < FRAMES; ++frame) {
        ff_print_text(&print, "1.5000 17.2500 -30.1250");
        for (int b = 0; b < BONES; ++b)
            ff_print_vec3(&print, ff_v3(angle(frame, b, 2), angle(frame, b, 1), angle(frame, b, 0)), 4);
        ff_print_text(&print, "\n");
    }
    return text_of_print(&print);
}

static int by_size(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(double *values)
{
    qsort(values, ROUNDS, sizeof *values, by_size);
    return values[ROUNDS / 2];
}

/* Every word of the text that strtod takes for a number. */
static double run_strtod(const text *t, double *sum)
{
    double start = seconds();
    for (const char *p = t->data; *p;) {
        char *next;
        double value = strtod(p, &next);
        if (next == p) { /* a name: over to its end */
            while (*p && *p != ' ' && *p != '\n')
                ++p;
            p += *p != '\0';
        } else {
            *sum += value;
            p = next;
        }
    }
    return seconds() - start;
}

/* asf is NULL for a BVH. */
static double run_reader(const text *t, const ff_asf *asf, ff_status *status, int *frames)
{
    ff_load_options options = ff_load_options_default();
    ff_clip clip;
    ff_error error;
    double start = seconds();
    *status = asf ? ff_amc_parse(asf, t->data, t->size, "amc", &options, &clip, &error)
                  : ff_bvh_parse(t->data, t->size, "bvh", &options, &clip, &error);
    double spent = seconds() - start;
    char line[1024];
    if (*status != FF_OK) fprintf(stderr, "%s\n", ff_error_text(&error, line, sizeof line));
    *frames = clip.frame_count;
    ff_clip_free(&clip);
    return spent;
}

static int measure(const char *what, const text *t, const ff_asf *asf)
{
    double reader[ROUNDS], library[ROUNDS], sum = 0.0;
    int frames = 0;
    for (int i = 0; i < ROUNDS; ++i) {
        ff_status status;
        reader[i] = run_reader(t, asf, &status, &frames);
        if (status != FF_OK) return 1;
        library[i] = run_strtod(t, &sum);
    }
    double mb = 1e-6 * (double)t->size;
    printf("%-14s %6.2f MB %6d frames   %6.0f MB/s into clips   strtod alone %6.0f MB/s   (sum %.6g)\n", what,
           mb, frames, mb / median(reader), mb / median(library), sum);
    return 0;
}

static int measure_set(const char *kind, text asf_text, text amc, text bvh)
{
    char what[32];
    ff_asf asf = {0};
    ff_error error;
    int failed = 1;
    if (asf_text.data && amc.data && bvh.data &&
        ff_asf_parse(asf_text.data, asf_text.size, "asf", false, &asf, &error) == FF_OK) {
        snprintf(what, sizeof what, "AMC %s", kind);
        failed = measure(what, &amc, &asf);
        snprintf(what, sizeof what, "BVH %s", kind);
        failed |= measure(what, &bvh, NULL);
    }
    ff_asf_free(&asf);
    free(asf_text.data);
    free(amc.data);
    free(bvh.data);
    return failed;
}

int main(void)
{
    const char *shared = getenv("FF_SHARED");
    int failed = measure_set("made up", made_up_asf(), made_up_amc(), made_up_bvh());
    if (shared && *shared)
        failed |= measure_set("CMU 01_01", text_of_file(shared, "01/01.asf"),
                              text_of_file(shared, "01/01_01.amc"), text_of_file(shared, "01/01_01.bvh"));
    return failed;
}
