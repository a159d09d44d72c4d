/* Gait examples: cycles of generated clips must have the rates the clips were made with, close, hold their feet still
 * while locked, and make a set that is the same to the left as to the right. */
#include "tests/preprocess/cycles_make.h"

#include "preprocess/examples/derive.h"
#include "preprocess/examples/examples.h"

/* Where the ball of a foot is in the world when the root, moving at the example's rates, was at the origin at frame
 * 0; k may go beyond the cycle. */
static ff_vec2 ball_in_world(const ff_example *e, int k, int foot)
{
    double t = k * (double)e->record.period / e->frame_count, turn = (double)e->record.turn_rate;
    const ff_pack_foot *f = &e->feet[2 * (k % e->frame_count) + foot];
    ff_vec2 root = ff_root_arc(ff_v2((double)e->record.v_forward, (double)e->record.v_left), turn, t);
    return ff_add2(root, ff_from_frame2(ff_fwd2(turn * t), ff_v2((double)f->ball[0], (double)f->ball[1])));
}

/* Largest distance of a locked ball from where it was when the lock began. */
static double lock_slide(const ff_example *e, int foot)
{
    int n = e->frame_count, from = (int)(n * (double)e->record.lock[foot][0] + 0.5);
    int to = (int)(n * (double)e->record.lock[foot][1] + 0.5);
    if (to < from) to += n;
    double worst = 0.0;
    for (int k = from; k <= to; ++k)
        worst = ff_max(worst, ff_length2(ff_sub2(ball_in_world(e, k, foot), ball_in_world(e, from, foot))));
    return worst;
}

/* Largest rotation of a joint from one frame to the next, over the seam too; toes may snap back. */
static double fastest_joint(const ff_example *e, bool seam_only)
{
    double worst = 0.0;
    int n = e->frame_count;
    for (int k = seam_only ? n - 1 : 0; k < n; ++k)
        for (int r = 0; r < FF_ROLE_JOINT_COUNT; ++r) {
            if (r == FF_ROLE_BALL_L || r == FF_ROLE_BALL_R) continue;
            ff_quat p = e->rotations[(size_t)k * FF_ROLE_JOINT_COUNT + (size_t)r];
            ff_quat q = e->rotations[(size_t)((k + 1) % n) * FF_ROLE_JOINT_COUNT + (size_t)r];
            worst = ff_max(worst, ff_quat_angle(ff_quat_mul(ff_quat_conj(p), q)));
        }
    return worst;
}

static void check_walk(const ff_example *e, double slide)
{
    const float *key = e->record.key;
    assert_true(key[0] == 0.0f && key[1] > 0.0f && key[1] < key[2] && key[2] < key[3] && key[3] < 1.0f);
    FF_ASSERT_NEAR(e->frame_count, (double)e->record.period * FF_PACK_RATE, 0.501);
    FF_ASSERT_BELOW(lock_slide(e, FF_LEFT), slide);
    FF_ASSERT_BELOW(lock_slide(e, FF_RIGHT), slide);
    FF_ASSERT_BELOW(fastest_joint(e, true), fastest_joint(e, false));
    FF_ASSERT_BELOW(fastest_joint(e, false), 0.35);
}

static void cycles_have_the_rates_the_clips_were_made_with(void **state)
{
    (void)state;
    ff_rig rig = rig_of_generated("walk-normal");
    for (int i = 0; i < ff_generator_count(); ++i) {
        ff_generator_info info = ff_generator_describe(i);
        if (!info.steady) continue;
        made_motion made = make_motion(&rig, generated_clip(info.name));
        ff_cycles cycles = cut_cycles(&rig, &made);
        if (cycles.count < 2) print_error("%s: %d cycles\n", info.name, cycles.count);
        assert_true(cycles.count >= 2);
        double scale = made.motion.scale;
        for (int k = 0; k < cycles.count; ++k) {
            const ff_example *e = &cycles.items[k];
            FF_ASSERT_NEAR((double)e->record.v_forward, info.forward * scale, 0.05);
            FF_ASSERT_NEAR((double)e->record.v_left, info.left * scale, 0.05);
            FF_ASSERT_NEAR((double)e->record.turn_rate, info.turn, 0.06);
            FF_ASSERT_BELOW((double)e->record.seam, 0.01);
            assert_int_equal(e->record.gait, strcmp(info.mode, "run") == 0 ? FF_GAIT_RUN : FF_GAIT_WALK);
            if (e->record.gait == FF_GAIT_WALK) check_walk(e, 0.03);
        }
        ff_cycles_free(&cycles);
        made_motion_free(&made);
    }
}

static void hips_and_facing_are_on_the_root_on_average(void **state)
{
    (void)state;
    made_cycles of = make_cycles("curve-left");
    const ff_example *e = &of.cycles.items[0];
    double ahead = 0.0, left = 0.0;
    for (int k = 0; k < e->frame_count; ++k) {
        ahead += e->hips[k].x / e->frame_count;
        left += e->hips[k].y / e->frame_count;
    }
    FF_ASSERT_NEAR(ahead, 0.0, 0.005);
    FF_ASSERT_NEAR(left, 0.0, 0.005);
    made_cycles_free(&of);
}

/* A captured head that hangs or tilts all the time was calibrated so: it is turned to look ahead, its motion stays. */
static void heads_look_ahead_however_they_were_captured(void **state)
{
    (void)state;
    ff_clip clip = generated_clip("walk-normal");
    ff_rig rig = rig_of(&clip);
    made_motion made = make_motion(&rig, clip);
    for (int k = 0; k < made.motion.frame_count; ++k) {
        ff_quat *head = &made.motion.rotations[(size_t)k * FF_ROLE_JOINT_COUNT + FF_ROLE_HEAD];
        *head = ff_quat_mul(*head, ff_quat_exp(ff_v3(0.4, 0.0, 0.15)));
    }
    ff_cycles cycles = cut_cycles(&rig, &made);
    const ff_example *e = &cycles.items[0];
    double ahead = 0.0, tilt = 0.0;
    for (int k = 0; k < e->frame_count; ++k) {
        ff_quat world = FF_QUAT_IDENTITY;
        for (int r = FF_ROLE_HEAD; r >= 0; r = (int)ff_role_parent((ff_role)r))
            world = ff_quat_mul(e->rotations[(size_t)k * FF_ROLE_JOINT_COUNT + (size_t)r], world);
        ahead += ff_quat_rotate(world, ff_v3(0.0, 0.0, 1.0)).y / e->frame_count;
        tilt += ff_quat_rotate(world, ff_v3(1.0, 0.0, 0.0)).y / e->frame_count;
    }
    FF_ASSERT_NEAR(ahead, -sin(5.0 * FF_DEG), 0.01);
    FF_ASSERT_NEAR(tilt, 0.0, 0.01);
    ff_cycles_free(&cycles);
    made_motion_free(&made);
}

static void a_mirrored_example_steps_with_the_other_foot_first(void **state)
{
    (void)state;
    made_cycles of = make_cycles("curve-left");
    const ff_example *e = &of.cycles.items[0];
    ff_example once, twice;
    ff_error error;
    FF_ASSERT_OK(ff_example_mirror(&of.rig, e, &once, &error), error);
    check_walk(&once, 0.03);
    FF_ASSERT_NEAR((double)once.record.turn_rate, -(double)e->record.turn_rate, 0.0);
    FF_ASSERT_NEAR((double)once.record.key[1], (double)e->record.key[3] - (double)e->record.key[2], 1e-6);
    assert_true(once.record.flags & FF_EXAMPLE_MIRRORED);
    /* its feet are the other's, reflected, half a cycle on */
    int shift = (int)(e->frame_count * (double)e->record.key[2] + 0.5);
    const ff_pack_foot *own = &once.feet[2 * 10 + FF_LEFT];
    const ff_pack_foot *other = &e->feet[2 * ((10 + shift) % e->frame_count) + FF_RIGHT];
    FF_ASSERT_NEAR((double)own->ball[0], (double)other->ball[0], 0.02);
    FF_ASSERT_NEAR((double)own->ball[1], -(double)other->ball[1], 0.01);
    FF_ASSERT_OK(ff_example_mirror(&of.rig, &once, &twice, &error), error);
    assert_false(twice.record.flags & FF_EXAMPLE_MIRRORED);
    for (int k = 0; k < e->frame_count; ++k)
        for (int r = 0; r < FF_ROLE_JOINT_COUNT; ++r) {
            size_t at = (size_t)k * FF_ROLE_JOINT_COUNT + (size_t)r;
            if (r == FF_ROLE_BALL_L || r == FF_ROLE_BALL_R) continue;
            ff_quat turn = ff_quat_mul(ff_quat_conj(e->rotations[at]), twice.rotations[at]);
            FF_ASSERT_BELOW(ff_quat_angle(turn), 0.12);
        }
    ff_example_free(&once);
    ff_example_free(&twice);
    made_cycles_free(&of);
}

static void a_walk_read_backwards_walks_backwards(void **state)
{
    (void)state;
    made_cycles of = make_cycles("walk-normal");
    ff_example back;
    ff_error error;
    FF_ASSERT_OK(ff_example_reverse(&of.rig, &of.cycles.items[0], &back, &error), error);
    FF_ASSERT_NEAR((double)back.record.v_forward, -(double)of.cycles.items[0].record.v_forward, 0.0);
    check_walk(&back, 0.04);
    ff_example_free(&back);
    made_cycles_free(&of);
}

static void check_knees(const ff_example *e, double least)
{
    for (int k = 0; k < e->frame_count; ++k)
        for (int r = FF_ROLE_KNEE_L; r <= FF_ROLE_KNEE_R; r += FF_ROLE_KNEE_R - FF_ROLE_KNEE_L) {
            ff_quat q = e->rotations[(size_t)k * FF_ROLE_JOINT_COUNT + (size_t)r];
            assert_true(ff_quat_angle(q) > least);
            assert_true(q.x * q.w > 0.0); /* shank turned back, not forwards */
        }
}

static void made_up_walks_hold_their_feet_and_bend_their_knees(void **state)
{
    (void)state;
    made_cycles of = make_cycles("walk-normal");
    ff_error error;
    const ff_derive_target targets[] = {{"step", 0.0, 0.0, 0.0, 1.1},   {"turn", 0.0, 0.0, 1.57, 0.95},
                                        {"side", 0.0, 0.55, 0.0, 0.85}, {"slow", 0.45, 0.0, 0.0, 1.3},
                                        {"curve", 0.7, 0.0, 1.5, 1.0},  {"mixed", 0.5, -0.3, -0.6, 1.1}};
    ff_gait_fit fit;
    ff_gait_fit_make(&of.rig, &of.cycles.items[0], NULL, 0, &fit);
    for (size_t i = 0; i < sizeof targets / sizeof targets[0]; ++i) {
        ff_example e;
        FF_ASSERT_OK(ff_derive_walk(&of.rig, &of.cycles.items[0], &fit, &targets[i], &e, &error), error);
        check_walk(&e, 0.03);
        check_knees(&e, 0.1);
        double lift[2] = {0.0, 0.0};
        for (int k = 0; k < 2 * e.frame_count; ++k) {
            assert_true((double)e.feet[k].ball[2] > 0.024);
            lift[k % 2] = ff_max(lift[k % 2], (double)e.feet[k].ball[2] - 0.025);
        }
        assert_true(lift[0] > 0.04 && lift[1] > 0.04);
        ff_example_free(&e);
    }
    ff_example idle;
    FF_ASSERT_OK(ff_derive_idle(&of.rig, &of.cycles.items[0], &idle, &error), error);
    check_knees(&idle, 0.1);
    FF_ASSERT_NEAR((double)idle.feet[0].ball[2], 0.025, 0.001);
    FF_ASSERT_NEAR((double)idle.feet[0].ball[1], -(double)idle.feet[1].ball[1], 1e-4);
    ff_example_free(&idle);
    made_cycles_free(&of);
}

static bool has_partner(const ff_example_set *set, const ff_example *e)
{
    for (int i = 0; i < set->count; ++i) {
        const ff_pack_example *r = &set->items[i].record;
        if (r->gait == e->record.gait && r->v_forward == e->record.v_forward &&
            r->v_left == 0.0f - e->record.v_left && r->turn_rate == 0.0f - e->record.turn_rate)
            return true;
    }
    return false;
}

/* From straight walks of one clip and nothing else. */
static void one_walking_clip_is_enough_for_a_set_that_turns_both_ways(void **state)
{
    (void)state;
    made_cycles of = make_cycles("walk-normal");
    int subject = 0;
    ff_example_set set;
    ff_error error;
    FF_ASSERT_OK(
        ff_examples_select(&standard()->cut.examples, &of.rig, &of.cycles, &subject, 1, &set, &error), error);
    assert_true(set.items[0].record.flags & FF_EXAMPLE_IDLE);
    bool in_place = false, left = false, back = false, side = false;
    for (int i = 0; i < set.count; ++i) {
        const ff_pack_example *r = &set.items[i].record;
        assert_true(has_partner(&set, &set.items[i]));
        bool still = r->v_forward == 0.0f && r->v_left == 0.0f;
        in_place = in_place || (still && r->turn_rate == 0.0f && !(r->flags & FF_EXAMPLE_IDLE));
        left = left || (still && r->turn_rate > 1.0f);
        back = back || r->v_forward < -0.5f;
        side = side || r->v_left > 0.4f;
    }
    assert_true(in_place && left && back && side);
    ff_example_set_free(&set);
    made_cycles_free(&of);
}

static void the_person_with_most_walks_is_the_base(void **state)
{
    (void)state;
    const char *names[] = {"walk-slow", "walk-normal", "walk-fast", "walk-normal"};
    const int subject[] = {4, 4, 4, 2};
    made_motion made[4];
    ff_cycles cycles[4];
    ff_rig rig = rig_of_generated("walk-normal");
    for (int i = 0; i < 4; ++i) {
        made[i] = make_motion(&rig, generated_clip(names[i]));
        cycles[i] = cut_cycles(&rig, &made[i]);
        for (int k = 0; k < cycles[i].count; ++k)
            cycles[i].items[k].clip = i;
    }
    ff_example_set set;
    ff_error error;
    FF_ASSERT_OK(ff_examples_select(&standard()->cut.examples, &rig, cycles, subject, 4, &set, &error),
                 error);
    assert_int_equal(set.base, 4);
    for (int i = 0; i < set.count; ++i)
        assert_true(set.items[i].clip != 3);
    ff_example_set_free(&set);
    for (int i = 0; i < 4; ++i) {
        ff_cycles_free(&cycles[i]);
        made_motion_free(&made[i]);
    }
}

static void clips_without_a_straight_walk_are_refused(void **state)
{
    (void)state;
    made_cycles of = make_cycles("idle");
    assert_int_equal(of.cycles.count, 0);
    ff_error error;
    FF_ASSERT_OK(ff_cycles_cut_idle(&standard()->cut.cycles, &of.rig, &of.made.motion, &of.made.plants, 0,
                                    "idle", &of.cycles, &error),
                 error);
    assert_int_equal(of.cycles.count, 1);
    FF_ASSERT_BELOW((double)of.cycles.items[0].record.seam, 0.01);
    int subject = 0;
    ff_example_set set;
    assert_int_equal(
        ff_examples_select(&standard()->cut.examples, &of.rig, &of.cycles, &subject, 1, &set, &error),
        FF_ERR_NO_DATA);
    made_cycles_free(&of);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cycles_have_the_rates_the_clips_were_made_with),
        cmocka_unit_test(hips_and_facing_are_on_the_root_on_average),
        cmocka_unit_test(heads_look_ahead_however_they_were_captured),
        cmocka_unit_test(a_mirrored_example_steps_with_the_other_foot_first),
        cmocka_unit_test(a_walk_read_backwards_walks_backwards),
        cmocka_unit_test(made_up_walks_hold_their_feet_and_bend_their_knees),
        cmocka_unit_test(one_walking_clip_is_enough_for_a_set_that_turns_both_ways),
        cmocka_unit_test(the_person_with_most_walks_is_the_base),
        cmocka_unit_test(clips_without_a_straight_walk_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
