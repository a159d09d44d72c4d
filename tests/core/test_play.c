/* Playing footsteps, measured from the poses alone: prints are stood on where and when the plan says, feet that stand do not move,
 * and no joint shows where one action ends and the next begins. */
#define _GNU_SOURCE
#include "tests/core/play_walk.h"

#include <stdlib.h>

#define HZ 60.0
#define CHAINS 60
#define ACTIONS 24
#define HARDLY (45.0 * FF_DEG) /* rad/s: joints that the built-in clips keep still are allowed so much */

/* Of each test; FF_CHAINS=400 walks so many. */
static uint64_t chain_count(void)
{
    const char *asked = getenv("FF_CHAINS");
    return asked ? strtoull(asked, NULL, 10) : CHAINS;
}

static int open_built_in(void **state)
{
    return play_world_open(state, ff_built_in_pack_path());
}

static int open_captured(void **state)
{
    const char *path = ff_captured_pack_path();
    *state = NULL;
    return path ? play_world_open(state, path) : 0;
}

static int close_world(void **state)
{
    return *state ? play_world_close(state) : 0;
}

static const play_world *world_of(void **state)
{
    if (!*state) {
        print_message("SKIPPED playing captured footsteps: the shared folder is not there\n");
        skip();
    }
    return *state;
}

/* How fast each joint turns in the pack's clips, both sides alike. One that no clip turns, as CMU's collars, is held otherwise in
 * one person's clips than in another's: it may turn as fast as a join takes up the most of such a difference (a cubic in its time). */
static void fastest_joints(const play_world *w, double out[FF_JOINT_COUNT])
{
    enum { MOST_CLIPS = 256 };
    static ff_quat pose[MOST_CLIPS][FF_JOINT_COUNT];
    ff_quat before[FF_JOINT_COUNT], now[FF_JOINT_COUNT];
    double held[FF_JOINT_COUNT] = {0.0};
    assert_in_range(w->pack->clip_count, 1, MOST_CLIPS);
    memset(out, 0, FF_JOINT_COUNT * sizeof *out);
    for (uint32_t c = 0; c < w->pack->clip_count; ++c) {
        uint32_t stream = w->pack->clips[c].stream;
        double seconds = ff_pack_stream_seconds(w->pack, stream);
        for (int k = 0; k / HZ <= seconds; ++k) {
            ff_pack_sample(w->pack, stream, k / HZ, 0, NULL, NULL, now, NULL);
            for (int j = 1; j < FF_JOINT_COUNT && k > 0; ++j)
                out[j] = ff_max(out[j], ff_quat_angle(ff_quat_mul(ff_quat_conj(before[j]), now[j])) * HZ);
            memcpy(before, now, sizeof now);
        }
        memcpy(pose[c], now, sizeof now); /* any pose tells how it is held */
        for (uint32_t other = 0; other < c; ++other)
            for (int j = 1; j < FF_JOINT_COUNT; ++j)
                held[j] = ff_max(held[j], ff_quat_angle(ff_quat_mul(ff_quat_conj(pose[other][j]), now[j])));
    }
    for (int j = 1; j < FF_JOINT_COUNT; ++j)
        if (out[j] < 1.0 * FF_DEG) out[j] = ff_max(HARDLY, 1.5 * held[j] / FF_POSE_OFFSET_TIME);
    static const int pairs[][2] = {{5, 9}, {6, 10}, {7, 11}, {8, 12}, {13, 17}, {14, 18}, {15, 19}, {16, 20}};
    for (size_t i = 0; i < sizeof pairs / sizeof pairs[0]; ++i)
        out[pairs[i][0]] = out[pairs[i][1]] = ff_max(out[pairs[i][0]], out[pairs[i][1]]);
}

/* One foot that lands at the end of an action. */
typedef struct landing_foot {
    ff_vec2 print;
    int foot;
    bool on_ball; /* the clip never puts its heel down: the ball alone stands on the print */
} landing_foot;

static landing_foot landing_of(const play_world *w, const ff_play_order *order)
{
    const ff_pack_action *action = &w->pack->actions[order->action];
    const ff_body_frame *body = &w->space->body;
    int foot = (int)action->swing, joint = FF_JOINT_BALL_L + foot * FF_JOINT_LEG_STRIDE;
    ff_vec2 local = ff_v2((double)action->land[0], (double)action->land[1]);
    ff_play_sample clip;
    ff_play_sample_at(w->set, order->action, w->set->actions[order->action].duration, &clip);
    ff_vec3 from_ball = ff_sub3(body->heel[foot], body->offset[joint]);
    double heel = clip.ball[foot].y + ff_quat_rotate(clip.foot[foot], from_ball).y;
    return (landing_foot){ff_add2(order->anchor, ff_from_frame2(ff_fwd2(order->heading), local)), foot,
                          heel - body->ball_rest - from_ball.y >= 0.012};
}

/* The foot lies on its print, the ball no more than height over where it rests. */
static bool is_down(const play_world *w, const play_frame *frame, const landing_foot *land, double height)
{
    const ff_body_frame *body = &w->space->body;
    int joint = FF_JOINT_BALL_L + land->foot * FF_JOINT_LEG_STRIDE;
    ff_vec3 ball = play_ball(frame, land->foot);
    double heel =
        body->ball_rest - body->offset[joint].y + body->heel[land->foot].y; /* of a foot that lies flat */
    return ff_length2(ff_sub2(ff_plane(ball), land->print)) < 0.01 && ball.y - body->ball_rest < height &&
           (land->on_ball || frame->heel[land->foot].y - heel < 0.012);
}

static void every_planned_print_is_stood_on_where_and_when_the_plan_says(void **state)
{
    const play_world *w = world_of(state);
    double most_off = 0.0, most_early = 0.0, most_moved = 0.0;
    int prints = 0;
    for (uint64_t seed = 1; seed <= chain_count(); ++seed) {
        ff_play play;
        play_chain chain;
        ff_play_order order;
        play_chain_begin(w, &play, &chain, seed);
        chain.vary = seed % 3 == 0;
        for (int i = 0; i < ACTIONS && play_chain_next(w, &play, &chain, &order); ++i) {
            ff_play_advance(w->set, &play, order.start);
            landing_foot land = landing_of(w, &order);
            double end = chain.time - 1e-6, plan = ff_play_landing(w->set, &play.step[0], land.foot);
            assert_true(plan > order.start && plan <= chain.time + 1e-9);
            play_frame stands = play_look(w, &play, plan), now = play_look(w, &play, end);
            most_off =
                ff_max(most_off, ff_length2(ff_sub2(ff_plane(play_ball(&now, land.foot)), land.print)));
            for (double time = plan; time < end; time += 0.5 / HZ) {
                now = play_look(w, &play, time);
                ff_vec3 moved = ff_sub3(play_ball(&now, land.foot), play_ball(&stands, land.foot));
                most_moved = ff_max(most_moved, ff_length2(ff_plane(moved)));
            }
            /* Down a frame later at the latest, and from then on ... */
            double down = plan + 1.0 / HZ;
            for (double time = down; time < chain.time + 1.01 / HZ; time += 0.5 / HZ) {
                now = play_look(w, &play, time);
                assert_true(is_down(w, &now, &land, 0.005));
            }
            /* ... and since a frame before at the earliest. */
            now = play_look(w, &play, down);
            while (down > order.start && is_down(w, &now, &land, 0.0035))
                now = play_look(w, &play, down -= 0.1 / HZ);
            most_early = ff_max(most_early, plan - down);
            ++prints;
        }
    }
    print_message("%d prints, at most %.1f mm off, %.1f ms early, moving by %.2f mm\n", prints,
                  1e3 * most_off, 1e3 * most_early, 1e3 * most_moved);
    assert_true(prints > (int)chain_count() * ACTIONS / 2);
    FF_ASSERT_BELOW(most_off, 0.01);
    FF_ASSERT_BELOW(most_early, 1.001 / HZ);
    FF_ASSERT_BELOW(most_moved, 1e-3);
}

typedef struct watched_foot {
    ff_vec3 stood;
    bool planted;
} watched_foot;

static void feet_that_stand_do_not_move_and_joins_do_not_show(void **state)
{
    const play_world *w = world_of(state);
    double fastest[FF_JOINT_COUNT], most_moved = 0.0, most_ratio = 0.0;
    fastest_joints(w, fastest);
    for (uint64_t seed = 100; seed < 100 + chain_count(); ++seed) {
        ff_play play;
        play_chain chain;
        ff_play_order order;
        play_frame before, now;
        watched_foot foot[2] = {{.planted = false}, {.planted = false}};
        int frame = 0;
        play_chain_begin(w, &play, &chain, seed);
        chain.vary = seed % 3 == 0;
        for (int i = 0; i < ACTIONS && play_chain_next(w, &play, &chain, &order); ++i) {
            for (; frame / HZ < chain.time - 1e-9; ++frame, before = now) {
                ff_play_targets at;
                ff_play_advance(w->set, &play, frame / HZ);
                ff_play_targets_at(w->set, &play, frame / HZ, &at);
                now = play_look(w, &play, frame / HZ);
                for (int f = 0; f < 2; ++f) {
                    ff_vec3 ball = play_ball(&now, f);
                    if (at.planted[f] && !foot[f].planted) foot[f].stood = ball;
                    foot[f].planted = at.planted[f] != 0;
                    ff_vec2 moved = ff_sub2(ff_plane(ball), ff_plane(foot[f].stood));
                    if (foot[f].planted) most_moved = ff_max(most_moved, ff_length2(moved));
                }
                for (int j = 1; j < FF_JOINT_COUNT && frame > 0; ++j) {
                    double speed =
                        ff_quat_angle(ff_quat_mul(ff_quat_conj(before.local[j]), now.local[j])) * HZ;
                    if (speed > HARDLY) most_ratio = ff_max(most_ratio, speed / fastest[j]);
                }
            }
        }
    }
    print_message("planted feet move at most %.2f mm; joints %.2f times their fastest in the clips\n",
                  1e3 * most_moved, most_ratio);
    FF_ASSERT_BELOW(most_moved, 1e-3);
    FF_ASSERT_BELOW(most_ratio, 1.5);
}

static void who_stands_moves_but_not_the_feet(void **state)
{
    const play_world *w = world_of(state);
    ff_play play;
    ff_play_order stand = {.action = w->stand, .pace = 1.0};
    ff_play_init(w->set, &play, &stand, 0.0, 3.0);
    play_frame first = play_look(w, &play, 0.0);
    double moved = 0.0;
    for (int i = 1; i < 600; ++i) {
        ff_play_advance(w->set, &play, i / HZ);
        play_frame now = play_look(w, &play, i / HZ);
        for (int f = 0; f < 2; ++f)
            FF_ASSERT_BELOW(ff_length3(ff_sub3(play_ball(&now, f), play_ball(&first, f))), 1e-3);
        moved = ff_max(moved, ff_length3(ff_sub3(now.at[FF_JOINT_HEAD], first.at[FF_JOINT_HEAD])));
    }
    assert_true(moved > 0.003); /* nobody stands like a post */
}

/* A captured stop may end while a foot still slides, so that no stance reaches the end: it stays where it then is. */
static void who_stops_on_a_foot_that_slides_stands_where_it_is(void **state)
{
    const play_world *w = world_of(state);
    int stops = 0;
    for (uint32_t i = 0; i < w->pack->action_count && stops < 20; ++i) {
        const ff_pack_action *action = &w->pack->actions[i];
        if (!(action->flags & FF_ACTION_TO_STANDING) || !play_may_follow(action)) continue;
        ff_play_action saved = w->set->actions[i];
        for (int foot = 0; foot < 2; ++foot) {
            ff_play play;
            ff_play_order order = {.action = w->stand, .pace = 1.0};
            ff_play_init(w->set, &play, &order, 0.0, 3.0);
            ff_play_foot stood = play.step[0].foot[action->support];
            order = (ff_play_order){i, 0, 0.5, 1.0, {stood.a, stood.b}, play.step[0].heading};
            w->set->actions[i].stance_count[foot] = 0;
            ff_play_next(w->set, &play, &order);
            ff_play_advance(w->set, &play, order.start);
            double end = play.step[0].end;
            play_frame before = play_look(w, &play, end - 1e-4);
            for (double time = end; time < end + 1.0; time += 0.1) {
                ff_play_advance(w->set, &play, time);
                play_frame now = play_look(w, &play, time);
                ff_vec3 moved = ff_sub3(play_ball(&now, foot), play_ball(&before, foot));
                FF_ASSERT_BELOW(ff_length2(ff_plane(moved)), 0.003);
                FF_ASSERT_NEAR(play_ball(&now, foot).y, w->space->body.ball_rest,
                               time < end + 0.3 ? 0.03 : 1e-3);
            }
            w->set->actions[i] = saved;
        }
        ++stops;
    }
    assert_true(stops > 3);
}

/* A copy played in one go and one played frame by frame are the same to the bit. */
static void the_pose_depends_on_the_time_alone(void **state)
{
    const play_world *w = world_of(state);
    ff_play slow, quick;
    play_chain chain, again;
    ff_play_order order;
    play_chain_begin(w, &slow, &chain, 5);
    play_chain_begin(w, &quick, &again, 5);
    for (int i = 0; i < ACTIONS && play_chain_next(w, &slow, &chain, &order); ++i) {
        assert_true(play_chain_next(w, &quick, &again, &order));
        for (double t = order.start - 0.4; t < order.start; t += 1.0 / 97.0)
            if (t >= slow.step[0].entered) play_look(w, &slow, t);
        for (double t = order.start; t < chain.time; t += 1.0 / 61.0)
            ff_play_advance(w->set, &slow, t);
        double time = 0.5 * (order.start + chain.time);
        ff_play_advance(w->set, &quick, time);
        play_frame p = play_look(w, &slow, time), q = play_look(w, &quick, time);
        assert_memory_equal(&p, &q, sizeof p);
    }
}

/* Breaking off: the action is left in its middle for another one on the same foot, and nothing jumps. */
static void a_step_can_be_broken_off_without_a_jump(void **state)
{
    const play_world *w = world_of(state);
    double fastest[FF_JOINT_COUNT], most = 0.0;
    fastest_joints(w, fastest);
    int cuts = 0;
    for (uint64_t seed = 1; seed <= chain_count(); ++seed) {
        ff_play play;
        play_chain chain;
        ff_play_order order;
        play_chain_begin(w, &play, &chain, seed);
        uint32_t from = w->stand;
        for (int i = 0; i < 6 && play_chain_next(w, &play, &chain, &order); ++i) {
            ff_play_advance(w->set, &play, order.start);
            if (i < 5) from = order.action;
        }
        const ff_pack_action *last = &w->pack->actions[from];
        double time = order.start + 0.3 * (chain.time - order.start);
        for (uint32_t k = 0; k < last->successor_count; ++k) {
            uint32_t other = w->pack->successors[last->first_successor + k].action;
            const ff_pack_action *action = &w->pack->actions[other];
            if (other == order.action || action->support != w->pack->actions[order.action].support ||
                !play_may_follow(action))
                continue;
            ff_play cut = play;
            ff_play_order to = order;
            to.action = other;
            to.start = time - 0.3 * w->set->actions[other].duration;
            play_frame old = play_look(w, &cut, time - 1.0 / HZ), now;
            ff_play_cut(w->set, &cut, &to, time);
            for (int frame = 0; frame < 12; ++frame, old = now) {
                ff_play_advance(w->set, &cut, time + frame / HZ);
                now = play_look(w, &cut, time + frame / HZ);
                for (int j = 1; j < FF_JOINT_COUNT; ++j) {
                    double speed = ff_quat_angle(ff_quat_mul(ff_quat_conj(old.local[j]), now.local[j])) * HZ;
                    if (speed > HARDLY) most = ff_max(most, speed / fastest[j]);
                }
            }
            ++cuts;
            break;
        }
    }
    print_message("%d steps broken off; joints %.2f times their fastest in the clips\n", cuts, most);
    assert_true(cuts > 3);
    FF_ASSERT_BELOW(most, 1.5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_planned_print_is_stood_on_where_and_when_the_plan_says),
        cmocka_unit_test(feet_that_stand_do_not_move_and_joins_do_not_show),
        cmocka_unit_test(who_stands_moves_but_not_the_feet),
        cmocka_unit_test(who_stops_on_a_foot_that_slides_stands_where_it_is),
        cmocka_unit_test(the_pose_depends_on_the_time_alone),
        cmocka_unit_test(a_step_can_be_broken_off_without_a_jump),
    };
    int failed = cmocka_run_group_tests_name("playing footsteps", tests, open_built_in, close_world);
    return failed + cmocka_run_group_tests_name("captured footsteps", tests, open_captured, close_world);
}
