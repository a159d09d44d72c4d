#include "preprocess/report/diff.h"

#include "preprocess/report/report_parts.h"

#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A part of the packs; its heading is printed before the first difference. */
typedef struct part {
    const char *heading;
    bool differs;
} part;

static void differ(part *p)
{
    if (!p->differs) printf("%s\n", p->heading);
    p->differs = true;
}

/* ------------------------------------------------------------------------------------------------------- settings */

static const char *say_value(const json_t *value, char *text, size_t size)
{
    char *dumped = value ? json_dumps(value, JSON_ENCODE_ANY | JSON_COMPACT) : NULL;
    snprintf(text, size, "%s", dumped ? dumped : "not there");
    free(dumped);
    return text;
}

static void diff_section(part *p, const char *section, json_t *a, json_t *b)
{
    const char *key;
    json_t *value;
    char was[64], is[64];
    json_object_foreach(a, key, value)
    {
        const json_t *other = json_object_get(b, key);
        if (other && json_equal(value, other)) continue;
        differ(p);
        printf("  %s.%s: %s, was %s\n", section, key, say_value(other, is, sizeof is),
               say_value(value, was, sizeof was));
    }
    json_object_foreach(b, key, value)
    {
        if (json_object_get(a, key)) continue;
        differ(p);
        printf("  %s.%s: %s, was not there\n", section, key, say_value(value, is, sizeof is));
    }
}

static json_t *meta_of(const ff_pack *pack)
{
    json_error_t place;
    json_t *meta = json_loadb(pack->meta, (size_t)pack->meta_size, 0, &place);
    return meta ? meta : json_object();
}

static bool diff_settings(const ff_pack *a, const ff_pack *b)
{
    part p = {"settings", false};
    json_t *meta_a = meta_of(a), *meta_b = meta_of(b), *value;
    json_t *was = json_object_get(meta_a, "settings"), *is = json_object_get(meta_b, "settings");
    json_t *made_a = json_object_get(meta_a, "version"), *made_b = json_object_get(meta_b, "version");
    const char *section;
    json_object_foreach(was, section, value) diff_section(&p, section, value, json_object_get(is, section));
    json_object_foreach(is, section, value)
    {
        if (!json_object_get(was, section)) diff_section(&p, section, NULL, value);
    }
    if (made_a && made_b && !json_equal(made_a, made_b)) {
        differ(&p);
        printf("  built by version %s, was %s\n", json_string_value(made_b), json_string_value(made_a));
    }
    json_decref(meta_a);
    json_decref(meta_b);
    return p.differs;
}

/* ---------------------------------------------------------------------------------------------------------- clips */

/* The clip of a pack that another's clip became: of the same source and name and from the same place in the file. */
static const ff_pack_clip *same_clip(const ff_pack *in, const ff_pack *of, const ff_pack_clip *clip)
{
    const char *name = ff_pack_string(of, clip->name), *source = ff_pack_string(of, clip->source);
    const ff_pack_clip *near = NULL;
    for (uint32_t i = 0; i < in->clip_count; ++i) {
        const ff_pack_clip *other = &in->clips[i];
        if (strcmp(ff_pack_string(in, other->name), name) != 0) continue;
        if (strcmp(ff_pack_string(in, other->source), source) != 0) continue;
        if (other->time_offset == clip->time_offset) return other;
        if (!near) near = other;
    }
    return near;
}

static double seconds_of(const ff_pack *pack, const ff_pack_clip *clip)
{
    return ff_pack_stream_seconds(pack, clip->stream);
}

/* Largest distance of hips and difference of joint rotations of two streams, at 20 moments. */
static void pose_difference(const ff_pack *a, const ff_pack_clip *was, const ff_pack *b,
                            const ff_pack_clip *is, double *metres, double *radians)
{
    enum { MOMENTS = 20 };
    *metres = *radians = 0.0;
    for (int k = 0; k <= MOMENTS; ++k) {
        ff_root_frame root[2];
        ff_vec3 hips[2];
        ff_quat turn[2][FF_PACK_MAX_JOINTS];
        double at = k * seconds_of(a, was) / MOMENTS;
        ff_pack_sample(a, was->stream, at, 0, &root[0], &hips[0], turn[0], NULL);
        ff_pack_sample(b, is->stream, at, 0, &root[1], &hips[1], turn[1], NULL);
        for (int i = 0; i < 2; ++i)
            ff_root_place(&root[i], &hips[i], &turn[i][0]);
        *metres = ff_max(*metres, ff_length3(ff_sub3(hips[0], hips[1])));
        for (uint32_t j = 0; j < a->joint_count && j < b->joint_count; ++j) {
            ff_quat q = ff_quat_mul(ff_quat_conj(turn[0][j]), turn[1][j]);
            double sine = sqrt(q.x * q.x + q.y * q.y + q.z * q.z);
            *radians = ff_max(*radians, 2.0 * ff_atan2(sine, fabs(q.w)));
        }
    }
}

/* ", 9 plants (were 8)" when the counts differ. */
static void say_count(const char *what, uint32_t was, uint32_t is)
{
    if (was != is) printf(", %u %s (were %u)", is, what, was);
}

static bool same_bytes(const void *x, const void *y, size_t count, size_t size)
{
    return count == 0 || memcmp(x, y, count * size) == 0;
}

/* Everything of a record but where other parts of the pack are. */
static bool same_plants(const ff_pack *a, const ff_pack_clip *was, const ff_pack *b, const ff_pack_clip *is)
{
    for (uint32_t i = 0; i < was->plant_count; ++i) {
        ff_pack_plant x = a->plants[was->first_plant + i], y = b->plants[is->first_plant + i];
        x.clip = y.clip = 0;
        if (!same_bytes(&x, &y, 1, sizeof x)) return false;
    }
    return true;
}

static bool same_actions(const ff_pack *a, const ff_pack_clip *was, const ff_pack *b, const ff_pack_clip *is)
{
    for (uint32_t i = 0; i < was->action_count; ++i) {
        const ff_pack_action *x = &a->actions[was->first_action + i], *y = &b->actions[is->first_action + i];
        bool same = x->mode == y->mode && x->support == y->support && x->t_0 == y->t_0 &&
                    x->t_end == y->t_end && x->theta == y->theta && x->energy == y->energy &&
                    x->step_length == y->step_length && x->step_width == y->step_width;
        if (!same) return false;
    }
    return true;
}

static void diff_clip(part *p, const ff_pack *a, const ff_pack_clip *was, const ff_pack *b,
                      const ff_pack_clip *is)
{
    double metres, radians;
    bool file = was->source_hash != is->source_hash;
    bool length = fabs(seconds_of(a, was) - seconds_of(b, is)) > 1e-6;
    bool plants = was->plant_count != is->plant_count || !same_plants(a, was, b, is);
    bool actions = was->action_count != is->action_count || !same_actions(a, was, b, is);
    bool words = strcmp(ff_pack_string(a, was->tags), ff_pack_string(b, is->tags)) != 0 ||
                 strcmp(ff_pack_string(a, was->licence), ff_pack_string(b, is->licence)) != 0 ||
                 strcmp(ff_pack_string(a, was->citation), ff_pack_string(b, is->citation)) != 0;
    pose_difference(a, was, b, is, &metres, &radians);
    bool poses = metres > 0.0 || radians > 1e-6;
    if (!file && !length && !plants && !actions && !words && !poses) return;
    differ(p);
    printf("  changed %s: %s", ff_pack_string(b, is->name), file ? "another file" : "the same file");
    if (length) printf(", %.2f s (was %.2f)", seconds_of(b, is), seconds_of(a, was));
    if (poses && !length)
        printf(", poses differ by up to %.1f mm and %.1f degrees", 1e3 * metres, radians / FF_DEG);
    say_count("plants", was->plant_count, is->plant_count);
    if (plants && was->plant_count == is->plant_count) printf(", plants elsewhere");
    say_count("actions", was->action_count, is->action_count);
    if (actions && was->action_count == is->action_count) printf(", other actions");
    if (words) printf(", other tags, licence or citation");
    printf("\n");
}

static void say_clip(part *p, const char *what, const ff_pack *pack, const ff_pack_clip *clip)
{
    differ(p);
    printf("  %s %s: %.2f s, %u plants, %u actions (%s)\n", what, ff_pack_string(pack, clip->name),
           seconds_of(pack, clip), clip->plant_count, clip->action_count, ff_pack_string(pack, clip->source));
}

static bool diff_clips(const ff_pack *a, const ff_pack *b)
{
    part p = {"clips", false};
    for (uint32_t i = 0; i < a->clip_count; ++i)
        if (!same_clip(b, a, &a->clips[i])) say_clip(&p, "removed", a, &a->clips[i]);
    for (uint32_t i = 0; i < b->clip_count; ++i) {
        const ff_pack_clip *was = same_clip(a, b, &b->clips[i]);
        if (was)
            diff_clip(&p, a, was, b, &b->clips[i]);
        else
            say_clip(&p, "added", b, &b->clips[i]);
    }
    return p.differs;
}

/* -------------------------------------------------------------------------------- skeleton, actions, examples, hull */

static bool diff_skeleton(const ff_pack *a, const ff_pack *b)
{
    part p = {"skeleton", false};
    if (a->joint_count != b->joint_count) {
        differ(&p);
        printf("  %u joints, were %u\n", b->joint_count, a->joint_count);
    }
    for (uint32_t j = 0; j < a->joint_count && j < b->joint_count; ++j) {
        ff_vec3 was = ff_pack_joint_offset(a, j), is = ff_pack_joint_offset(b, j);
        if (ff_length3(ff_sub3(is, was)) == 0.0) continue;
        differ(&p);
        printf("  %s: %.1f mm from its parent, was %.1f (moved by %.1f)\n", ff_pack_joint_name(b, j),
               1e3 * ff_length3(is), 1e3 * ff_length3(was), 1e3 * ff_length3(ff_sub3(is, was)));
    }
    return p.differs;
}

/* Captured, made up, mirrored. */
static void count_actions(const ff_pack *pack, uint32_t mode, uint32_t count[3])
{
    count[0] = count[1] = count[2] = 0;
    for (uint32_t i = 0; i < pack->action_count; ++i) {
        const ff_pack_action *a = &pack->actions[i];
        if (a->mode == mode)
            ++count[a->flags & FF_ACTION_MIRRORED ? 2 : (a->flags & FF_ACTION_DERIVED ? 1 : 0)];
    }
}

static bool diff_actions(const ff_pack *a, const ff_pack *b)
{
    static const char *const kinds[] = {"captured", "made up", "mirrored"};
    part p = {"actions", false};
    for (uint32_t mode = 0; mode < FF_MODE_COUNT; ++mode) {
        uint32_t was[3], is[3];
        count_actions(a, mode, was);
        count_actions(b, mode, is);
        for (int kind = 0; kind < 3; ++kind) {
            if (was[kind] == is[kind]) continue;
            differ(&p);
            printf("  %s, %s: %u, were %u\n", ff_report_mode(mode), kinds[kind], is[kind], was[kind]);
        }
    }
    if (a->successor_count != b->successor_count) {
        differ(&p);
        printf("  ways to go on: %u, were %u\n", b->successor_count, a->successor_count);
    }
    return p.differs;
}

static const ff_pack_example *same_example(const ff_pack *in, const ff_pack *of, const ff_pack_example *e)
{
    for (uint32_t i = 0; i < in->example_count; ++i)
        if (strcmp(ff_pack_string(in, in->examples[i].name), ff_pack_string(of, e->name)) == 0)
            return &in->examples[i];
    return NULL;
}

static void say_example(part *p, const char *what, const ff_pack *pack, const ff_pack_example *e)
{
    differ(p);
    printf("  %s %s: %.2f m/s ahead, %.2f to the left, %.0f degrees/s, cycle of %.2f s%s\n", what,
           ff_pack_string(pack, e->name), (double)e->v_forward, (double)e->v_left,
           (double)e->turn_rate / FF_DEG, (double)e->period,
           e->flags & FF_EXAMPLE_DERIVED ? ", made up" : "");
}

static bool diff_examples(const ff_pack *a, const ff_pack *b)
{
    part p = {"examples", false};
    for (uint32_t i = 0; i < a->example_count; ++i)
        if (!same_example(b, a, &a->examples[i])) say_example(&p, "removed", a, &a->examples[i]);
    for (uint32_t i = 0; i < b->example_count; ++i) {
        const ff_pack_example *is = &b->examples[i], *was = same_example(a, b, is);
        if (!was) {
            say_example(&p, "added", b, is);
        } else if (was->v_forward != is->v_forward || was->v_left != is->v_left ||
                   was->turn_rate != is->turn_rate || was->period != is->period) {
            say_example(&p, "was", a, was);
            say_example(&p, "is now", b, is);
        }
    }
    return p.differs;
}

/* Area of the hull and how far it goes to the front, back and sides (m/s). */
typedef struct hull_size {
    double area, front, back, side;
} hull_size;

static hull_size size_of_hull(const ff_pack *pack)
{
    hull_size s = {0.0, 0.0, 0.0, 0.0};
    for (uint32_t i = 0; i < pack->hull_count; ++i) {
        ff_pack_point2 p = pack->hull[i], q = pack->hull[(i + 1) % pack->hull_count];
        s.area += 0.5 * ((double)p.f * (double)q.l - (double)q.f * (double)p.l);
        s.front = ff_max(s.front, (double)p.f);
        s.back = ff_max(s.back, -(double)p.f);
        s.side = ff_max(s.side, fabs((double)p.l));
    }
    return s;
}

static bool diff_hull(const ff_pack *a, const ff_pack *b)
{
    part p = {"velocity hull", false};
    if (a->hull_count == b->hull_count && same_bytes(a->hull, b->hull, a->hull_count, sizeof *a->hull))
        return false;
    hull_size was = size_of_hull(a), is = size_of_hull(b);
    differ(&p);
    printf("  ahead to %.2f m/s (was %.2f), back to %.2f (%.2f), aside to %.2f (%.2f), area %.2f (%.2f)\n",
           is.front, was.front, is.back, was.back, is.side, was.side, is.area, was.area);
    return true;
}

bool ff_packs_diff(const ff_pack *a, const ff_pack *b)
{
    if (a->size == b->size && memcmp(a->data, b->data, a->size) == 0) {
        printf("the same, byte for byte\n");
        return false;
    }
    bool differs = diff_settings(a, b);
    differs = diff_skeleton(a, b) || differs;
    differs = diff_clips(a, b) || differs;
    differs = diff_actions(a, b) || differs;
    differs = diff_examples(a, b) || differs;
    differs = diff_hull(a, b) || differs;
    if (!differs)
        printf("bytes differ, but nothing that is compared here: settings, skeleton, clips, actions, "
               "examples, hull\n");
    return true;
}
