/* What a pack's actions are good for: mirror images, successors, small sets, and what is derived. */
#define _GNU_SOURCE
#include "mocap/write.h"
#include "preprocess/actions/successors.h"
#include "preprocess/build/build.h"
#include "preprocess/report/coverage.h"
#include "runtime/core/pack/pack.h"
#include "tests/core/pack_seal.h"
#include "tests/preprocess/motion_make.h"
#include "tests/preprocess/standard.h"

#include <stdio.h>
#include <unistd.h>

/* A pack of some clips, in memory. */
typedef struct built {
    void *image;
    ff_pack *pack;
} built;

static char folder[] = "/tmp/ff-actions-XXXXXX";
static const char *const clip_names[] = {"walk-normal", "walk-slow", "walk-fast", "curve-left",
                                         "strafe-left", "run",       "start-left"};
enum { CLIP_COUNT = sizeof clip_names / sizeof clip_names[0] };

static void clip_path(int i, char path[256])
{
    snprintf(path, 256, "%s/%s.bvh", folder, clip_names[i]);
}

static int write_clips(void **state)
{
    (void)state;
    assert_non_null(mkdtemp(folder));
    for (int i = 0; i < CLIP_COUNT; ++i) {
        char path[256];
        ff_error error;
        ff_clip clip = generated_clip(clip_names[i]);
        clip_path(i, path);
        FF_ASSERT_OK(ff_bvh_write(path, &clip, &error), error);
        ff_clip_free(&clip);
    }
    return 0;
}

static int remove_clips(void **state)
{
    (void)state;
    for (int i = 0; i < CLIP_COUNT; ++i) {
        char path[256];
        clip_path(i, path);
        unlink(path);
    }
    return rmdir(folder);
}

static built build_in(int64_t actions, bool derive)
{
    ff_build_settings settings = ff_build_settings_default();
    const char *inputs[] = {folder};
    ff_catalogue catalogue;
    ff_build_result result;
    ff_error error;
    built b;
    size_t size;
    settings.quiet = true;
    settings.pack.cut.motion.clean = false; /* takes long, and changes nothing here */
    settings.pack.actions.count = actions;
    settings.pack.actions.derive = derive;
    FF_ASSERT_OK(ff_catalogue_read(inputs, 1, &catalogue, &error), error);
    FF_ASSERT_OK(ff_build(&catalogue, &settings, &result, &error), error);
    FF_ASSERT_OK(ff_pack_image(&result.content, &b.image, &size, &error), error);
    FF_ASSERT_OK(ff_pack_open_memory(b.image, size, &b.pack, &error), error);
    ff_build_result_free(&result);
    ff_catalogue_free(&catalogue);
    return b;
}

static void built_free(built *b)
{
    ff_pack_close(b->pack);
    free(b->image);
}

/* One clip's actions on a rig. */
typedef struct cut_clip {
    made_motion made;
    ff_actions actions;
} cut_clip;

static cut_clip cut(const ff_rig *rig, ff_clip clip)
{
    cut_clip c;
    ff_error error;
    c.made = make_motion(rig, clip);
    FF_ASSERT_OK(
        ff_actions_cut(&standard()->cut, rig, &c.made.motion, &c.made.plants, -1, &c.actions, &error), error);
    return c;
}

static void cut_free(cut_clip *c)
{
    ff_actions_free(&c->actions);
    made_motion_free(&c->made);
}

/* Numbers of a record that differ by more than tolerance: their count. */
static int differences(const ff_pack_action *x, const ff_pack_action *y, double tolerance)
{
    size_t first = offsetof(ff_pack_action, t_0) / sizeof(float),
           last = offsetof(ff_pack_action, first_collider) / sizeof(float);
    const float *p = (const float *)(const void *)x, *q = (const float *)(const void *)y;
    int count = 0;
    for (size_t i = first; i < last; ++i)
        count += fabs(ff_wrap((double)p[i] - (double)q[i])) > tolerance &&
                 fabs((double)p[i] - (double)q[i]) > tolerance;
    return count;
}

static void mirroring_twice_changes_nothing(void **state)
{
    (void)state;
    ff_clip clip = generated_clip("curve-left");
    ff_rig rig = rig_of(&clip);
    cut_clip c = cut(&rig, clip);
    assert_true(c.actions.count > 5);
    for (int i = 0; i < c.actions.count; ++i) {
        ff_action once, twice;
        ff_action_mirror(&c.actions.items[i], &once);
        ff_action_mirror(&once, &twice);
        assert_int_equal(differences(&c.actions.items[i].record, &twice.record, 1e-6), 0);
        assert_memory_equal(&c.actions.items[i].start, &twice.start, sizeof twice.start);
        assert_memory_equal(&c.actions.items[i].end, &twice.end, sizeof twice.end);
        assert_int_equal(once.record.support, 1 - c.actions.items[i].record.support);
        for (uint32_t k = 0; k < twice.record.event_count; ++k)
            assert_int_equal(twice.events[k].foot, c.actions.items[i].events[k].foot);
    }
    /* The motion too, to 1e-6. */
    ff_motion once, twice;
    ff_error error;
    FF_ASSERT_OK(ff_motion_mirror(&c.made.motion, &once, &error), error);
    FF_ASSERT_OK(ff_motion_mirror(&once, &twice, &error), error);
    for (int k = 0; k < twice.frame_count; ++k) {
        FF_ASSERT_BELOW(ff_length3(ff_sub3(twice.root[k], c.made.motion.root[k])), 1e-6);
        for (int r = 0; r < FF_ROLE_JOINT_COUNT; ++r) {
            int i = k * FF_ROLE_JOINT_COUNT + r;
            FF_ASSERT_BELOW(1.0 - fabs(ff_quat_dot(twice.rotations[i], c.made.motion.rotations[i])), 1e-6);
        }
    }
    ff_motion_free(&once);
    ff_motion_free(&twice);
    cut_free(&c);
}

static void assert_mirrored(const char *name, const ff_action *mine, const ff_action *theirs)
{
    const ff_pack_action *r = &mine->record, *other = &theirs->record;
    assert_int_equal(r->support, other->support);
    assert_int_equal(r->mode, other->mode);
    assert_int_equal(r->event_count, other->event_count);
    assert_int_equal(r->collider_samples, other->collider_samples);
    if (differences(r, other, 1e-6))
        print_error("%s from %.2f s: land %.7f %.7f and %.7f %.7f; theta %.7f %.7f\n", name, (double)r->t_0,
                    (double)r->land[0], (double)r->land[1], (double)other->land[0], (double)other->land[1],
                    (double)r->theta, (double)other->theta);
    assert_int_equal(differences(r, other, 1e-6), 0);
    for (uint32_t k = 0; k < r->event_count; ++k)
        FF_ASSERT_NEAR(mine->events[k].time, theirs->events[k].time, 0.0);
    for (uint32_t k = 0; k < r->collider_samples; ++k)
        for (int c = 0; c < FF_COLLIDER_COUNT; ++c)
            FF_ASSERT_NEAR(mine->colliders[k][c].b, theirs->colliders[k][c].b, 2e-6);
    for (int j = 0; j < FF_ROLE_JOINT_COUNT; ++j)
        FF_ASSERT_NEAR(mine->start.at[0][j][1], theirs->start.at[0][j][1], 2e-6);
}

/* The generator makes many clips with either foot: the mirror image of one is the other. */
static void mirror_images_are_what_the_other_foot_does(void **state)
{
    (void)state;
    int pairs = 0;
    for (int i = 0; i < ff_generator_count(); ++i) {
        char name[64];
        snprintf(name, sizeof name, "%s", ff_generator_describe(i).name);
        char *side = strstr(name, "left");
        if (!side) continue;
        ff_clip left = generated_clip(name);
        char rest[64];
        snprintf(rest, sizeof rest, "right%s", side + 4);
        memcpy(side, rest, strlen(rest) + 1);
        ff_clip right = generated_clip(name);
        ff_rig rig = rig_of(&left);
        cut_clip c = cut(&rig, left), d = cut(&rig, right);
        assert_int_equal(c.actions.count, d.actions.count);
        for (int k = 0; k < c.actions.count; ++k) {
            ff_action mirrored;
            ff_action_mirror(&c.actions.items[k], &mirrored);
            /* Two actions of one time and foot; standing has no foot of its own. */
            if (mirrored.record.mode != FF_MODE_IDLE) assert_mirrored(name, &mirrored, &d.actions.items[k]);
        }
        cut_free(&c);
        cut_free(&d);
        ++pairs;
    }
    assert_true(pairs >= 15);
}

static bool leads_to_standing(const ff_pack *pack, const ff_pack_action *a)
{
    for (uint32_t i = 0; i < a->successor_count; ++i)
        if (pack->actions[pack->successors[a->first_successor + i].action].flags & FF_ACTION_TO_STANDING)
            return true;
    return false;
}

static void every_action_goes_on_and_every_walk_comes_to_stand(void **state)
{
    (void)state;
    const int64_t sizes[] = {0, 28};
    for (int s = 0; s < 2; ++s) {
        built b = build_in(sizes[s], true);
        const ff_pack *pack = b.pack;
        if (sizes[s]) {
            uint32_t own = 0;
            for (uint32_t i = 0; i < pack->action_count; ++i)
                own += !(pack->actions[i].flags & FF_ACTION_MIRRORED);
            assert_int_equal(own, sizes[s]);
        }
        for (uint32_t i = 0; i < pack->action_count; ++i) {
            const ff_pack_action *a = &pack->actions[i];
            assert_true(a->successor_count >= 1);
            if (a->mode != FF_MODE_WALK_SHORT && a->mode != FF_MODE_WALK_LONG) continue;
            bool stands = leads_to_standing(pack, a);
            for (uint32_t k = 0; k < a->successor_count && !stands; ++k)
                stands =
                    leads_to_standing(pack, &pack->actions[pack->successors[a->first_successor + k].action]);
            assert_true(stands);
        }
        built_free(&b);
    }
}

/* In one clip the step that really followed follows best: its joint is where the poses are the same. */
static void the_step_that_followed_is_the_nearest(void **state)
{
    (void)state;
    ff_clip clip = generated_clip("walk-normal");
    ff_rig rig = rig_of(&clip);
    cut_clip c = cut(&rig, clip);
    int pairs = 0;
    for (int i = 0; i + 1 < c.actions.count; ++i) {
        const ff_action *a = &c.actions.items[i], *b = &c.actions.items[i + 1];
        if (b->first_frame != a->last_frame) continue;
        const ff_action_joins p = {a->start, a->end}, q = {b->start, b->end};
        assert_true(ff_may_follow(&standard()->successors, &a->record, &b->record));
        FF_ASSERT_BELOW(ff_join_distance(&a->record, &p, &b->record, &q, 1.0), 1e-4);
        ++pairs;
    }
    assert_true(pairs >= 5);
    assert_false(ff_may_follow(&standard()->successors, &c.actions.items[0].record,
                               &c.actions.items[0].record)); /* the same foot again */
    cut_free(&c);
}

/* Distances are root mean squares over weighted joints: shifting a pose by d gives d. */
static void the_distance_is_in_metres(void **state)
{
    (void)state;
    ff_clip clip = generated_clip("walk-normal");
    ff_rig rig = rig_of(&clip);
    cut_clip c = cut(&rig, clip);
    ff_action_joins p = {c.actions.items[0].start, c.actions.items[0].end}, q = {p.end, p.end};
    for (int k = 0; k < FF_JOIN_FRAMES; ++k)
        for (int j = 0; j < FF_ROLE_JOINT_COUNT; ++j)
            q.start.at[k][j][1] += 0.07f;
    const ff_pack_action *a = &c.actions.items[0].record, *b = &c.actions.items[1].record;
    FF_ASSERT_NEAR(ff_join_distance(a, &p, b, &q, 1.0), 0.07, 1e-6);
    FF_ASSERT_NEAR(ff_join_limit(&standard()->successors, 28), 0.15, 1e-12);
    FF_ASSERT_NEAR(ff_join_limit(&standard()->successors, 300), 0.10, 1e-12);
    cut_free(&c);
}

static void derived_actions_fill_what_is_missing_and_stand_where_they_should(void **state)
{
    (void)state;
    built without = build_in(0, false), with = build_in(0, true);
    int kinds_without = 0, kinds_with = 0;
    for (int k = 0; k < ff_coverage_kinds(); ++k) {
        kinds_without += ff_coverage_count(without.pack, k) > 0;
        kinds_with += ff_coverage_count(with.pack, k) > 0;
        if (ff_coverage_count(without.pack, k) > 0) assert_true(ff_coverage_count(with.pack, k) > 0);
    }
    assert_true(kinds_with > kinds_without);
    int derived = 0;
    for (uint32_t i = 0; i < with.pack->action_count; ++i) {
        const ff_pack_action *a = &with.pack->actions[i];
        if (!(a->flags & FF_ACTION_DERIVED)) continue;
        ++derived;
        assert_true(with.pack->clips[a->clip].flags & FF_CLIP_DERIVED);
        /* All but a leap, which goes from one step of a walk to another. */
        assert_true((a->flags & (FF_ACTION_FROM_STANDING | FF_ACTION_TO_STANDING)) ||
                    a->mode == FF_MODE_JUMP);
        assert_true(a->successor_count >= 1);
        assert_true(a->coarse_radius > 0.3f && a->coarse_radius < 1.0f);
    }
    assert_true(derived >= 8);
    built_free(&without);
    built_free(&with);
}

static void events_are_what_the_plants_say(void **state)
{
    (void)state;
    ff_clip clip = generated_clip("walk-normal");
    ff_rig rig = rig_of(&clip);
    cut_clip c = cut(&rig, clip);
    for (int i = 0; i < c.actions.count; ++i) {
        const ff_action *a = &c.actions.items[i];
        int kinds[2][FF_EVENT_KIND_COUNT] = {{0}};
        for (uint32_t k = 0; k < a->record.event_count; ++k) {
            const ff_pack_event *e = &a->events[k];
            const ff_plant *p = &c.made.plants.items[e->plant];
            const int frames[] = {p->start, p->flat_start, p->flat_end + 1, p->end + 1};
            assert_int_equal(e->foot, p->foot);
            FF_ASSERT_NEAR(e->time, frames[e->kind] * c.made.motion.frame_time, 1e-5);
            ++kinds[e->foot][e->kind];
        }
        if (a->record.mode != FF_MODE_WALK_SHORT && a->record.mode != FF_MODE_WALK_LONG) continue;
        /* A walking step: the old support foot's heel and the swing foot's toes leave, the swing foot lands. */
        assert_int_equal(kinds[a->record.swing][FF_EVENT_CONTACT], 1);
        assert_int_equal(kinds[a->record.swing][FF_EVENT_TOE_OFF], 1);
        assert_int_equal(kinds[a->record.support][FF_EVENT_HEEL_OFF], 1);
    }
    cut_free(&c);
}

/* The image with one record changed is refused, with the section's name. */
static void refuses(const built *b, size_t size, size_t at, const void *value, size_t bytes,
                    const char *section)
{
    void *copy = NULL;
    ff_pack *pack = NULL;
    ff_error error;
    assert_int_equal(posix_memalign(&copy, FF_PACK_ALIGN, size), 0);
    memcpy(copy, b->image, size);
    memcpy((char *)copy + at, value, bytes);
    ff_pack_seal(copy, size);
    assert_int_equal(ff_pack_open_memory(copy, size, &pack, &error), FF_ERR_PARSE);
    assert_string_equal(error.section, section);
    free(copy);
}

static void the_loader_refuses_events_and_successors_that_do_not_fit(void **state)
{
    (void)state;
    built b = build_in(0, false);
    const ff_pack *pack = b.pack;
    const char *image = b.image;
    const ff_pack_action *first = NULL;
    for (uint32_t i = 0; i < pack->action_count && !first; ++i)
        if (pack->actions[i].successor_count >= 3 && pack->actions[i].event_count >= 3)
            first = &pack->actions[i];
    assert_non_null(first);
    const ff_pack_successor *next = &pack->successors[first->first_successor];
    const ff_pack_event *event = &pack->events[first->first_event];
#define PLACE(member) (size_t)((const char *)(member)-image)
    const uint32_t many = 0x7fffffff, two = 2, foot = 7;
    const float far = 9.0f, minus = -1.0f, nothing = NAN, late = first->t_end + 1.0f;
    refuses(&b, pack->size, PLACE(&next->action), &pack->action_count, 4, "NEXT");
    refuses(&b, pack->size, PLACE(&next->distance), &far, 4, "NEXT");
    refuses(&b, pack->size, PLACE(&next->distance), &nothing, 4, "NEXT");
    refuses(&b, pack->size, PLACE(&next->cost), &minus, 4, "NEXT");
    refuses(&b, pack->size, PLACE(&event->time), &late, 4, "EVNT");
    refuses(&b, pack->size, PLACE(&event->foot), &two, 4, "EVNT");
    refuses(&b, pack->size, PLACE(&event->kind), &foot, 4, "EVNT");
    refuses(&b, pack->size, PLACE(&event->plant), &pack->plant_count, 4, "EVNT");
    refuses(&b, pack->size, PLACE(&first->first_event), &many, 4, "ACTN");
    refuses(&b, pack->size, PLACE(&first->successor_count), &many, 4, "ACTN");
    refuses(&b, pack->size, PLACE(&first->flags), &many, 4, "ACTN");
    refuses(&b, pack->size, PLACE(&pack->clips[0].flags), &many, 4, "CLIP");
    refuses(&b, pack->size, PLACE(&pack->plants[0].origin), &foot, 4, "PLNT");
    refuses(&b, pack->size, PLACE(&pack->plants[0].level), &nothing, 4, "PLNT");
#undef PLACE
    built_free(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(mirroring_twice_changes_nothing),
        cmocka_unit_test(mirror_images_are_what_the_other_foot_does),
        cmocka_unit_test(every_action_goes_on_and_every_walk_comes_to_stand),
        cmocka_unit_test(the_step_that_followed_is_the_nearest),
        cmocka_unit_test(the_distance_is_in_metres),
        cmocka_unit_test(derived_actions_fill_what_is_missing_and_stand_where_they_should),
        cmocka_unit_test(events_are_what_the_plants_say),
        cmocka_unit_test(the_loader_refuses_events_and_successors_that_do_not_fit),
    };
    return cmocka_run_group_tests(tests, write_clips, remove_clips);
}
