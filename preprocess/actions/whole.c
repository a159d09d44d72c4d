#include "preprocess/actions/whole.h"

#include "preprocess/actions/annotate.h"

#include <stdlib.h>

enum { MOST_LANDINGS = 6 }; /* inside a jump from standing: a hop here and there, no walk */

/* Do both feet leave the ground, or come to it, at this frame? */
static bool both_at(const ff_whole_settings *set, const ff_motion *motion, const ff_plants *plants, int frame,
                    bool leave)
{
    bool foot[2] = {false, false};
    for (int i = 0; i < plants->count; ++i) {
        const ff_plant *p = &plants->items[i];
        int at = leave ? p->end + 1 : p->start;
        if (abs(at - frame) * motion->frame_time <= set->together) foot[p->foot] = true;
    }
    return foot[0] && foot[1];
}

bool ff_flight_is_jump(const ff_whole_settings *set, const ff_motion *motion, const ff_plants *plants,
                       int from, int to)
{
    double seconds = (to - from + 1) * motion->frame_time;
    if (seconds >= set->jump) return true;
    bool leave = both_at(set, motion, plants, from, true), land = both_at(set, motion, plants, to + 1, false);
    return (leave && land) || (seconds >= 0.5 * set->jump && (leave || land));
}

static bool has_jump(const ff_whole_settings *set, const ff_motion *motion, const ff_plants *plants,
                     int first, int last)
{
    int from = 0, to = 0;
    return ff_find_flight(plants, first, last, &from, &to) &&
           ff_flight_is_jump(set, motion, plants, from, to);
}

static double lowest_hips(const ff_rig *rig, const ff_motion *motion, const ff_plants *plants, int first,
                          int last)
{
    double low = ff_hips_height(motion, plants, first);
    for (int i = first; i <= last; ++i)
        low = ff_min(low, ff_hips_height(motion, plants, i));
    return low / rig->offset[FF_ROLE_HIPS].y;
}

static int landings_within(const ff_landing *landings, int count, int first, int last)
{
    int n = 0;
    for (int i = 0; i < count; ++i)
        n += landings[i].frame > first && landings[i].frame <= last;
    return n;
}

/* What a person does from one standing to the next, when it is one thing. -1: it is a walk. */
static int mode_between(const ff_cut_settings *set, const ff_rig *rig, const ff_motion *motion,
                        const ff_plants *plants, const ff_landing *landings, int landing_count, int first,
                        int last)
{
    int steps = landings_within(landings, landing_count, first, last);
    ff_vec3 moved = ff_sub3(motion->root[last], motion->root[first]);
    bool on_the_spot = ff_length2(ff_v2(moved.x, moved.y)) < set->whole.turn_travel;
    if (steps <= MOST_LANDINGS && has_jump(&set->whole, motion, plants, first, last)) return FF_MODE_JUMP;
    if (steps <= MOST_LANDINGS && lowest_hips(rig, motion, plants, first, last) < set->steps.crouched)
        return FF_MODE_CROUCH;
    if (steps > 0 && on_the_spot && fabs(moved.z) > set->whole.turn_angle * FF_DEG) return FF_MODE_TURN;
    return -1;
}

static int by_first(const void *x, const void *y)
{
    const ff_whole *p = x, *q = y;
    return p->first != q->first ? (p->first > q->first) - (p->first < q->first)
                                : (p->last > q->last) - (p->last < q->last);
}

/* Frames of the landings before and after a stretch, with the hips up; false when there is none. */
static bool landings_around(const ff_whole_settings *set, const ff_rig *rig, const ff_motion *motion,
                            const ff_plants *plants, const ff_landing *landings, int count, int from, int to,
                            ff_whole *out)
{
    double up = set->upright * rig->offset[FF_ROLE_HIPS].y;
    out->first = out->last = -1;
    for (int i = 0; i < count; ++i) {
        if (ff_hips_height(motion, plants, landings[i].frame) < up) continue;
        if (landings[i].frame <= from) out->first = landings[i].frame;
        if (landings[i].frame > to && out->last < 0) out->last = landings[i].frame;
    }
    return out->first >= 0 && out->last > out->first &&
           (out->last - out->first) * motion->frame_time <= set->longest;
}

static bool overlaps(const ff_whole *list, int count, const ff_whole *w)
{
    for (int i = 0; i < count; ++i)
        if (list[i].first < w->last && list[i].last > w->first) return true;
    return false;
}

/* Ducks on the way: down and up again while walking or running. */
static int find_ducks(const ff_cut_settings *set, const ff_rig *rig, const ff_motion *motion,
                      const ff_plants *plants, const ff_landing *landings, int landing_count, ff_whole *out,
                      int count, int capacity)
{
    double low = set->steps.crouched * rig->offset[FF_ROLE_HIPS].y;
    int begin = -1;
    for (int i = 0; i < motion->frame_count; ++i) {
        bool down = ff_hips_height(motion, plants, i) < low;
        if (down && begin < 0) begin = i;
        if (down || begin < 0) continue;
        ff_whole w = {.mode = FF_MODE_CROUCH};
        if ((i - begin) * motion->frame_time <= set->whole.longest_duck && count < capacity &&
            landings_around(&set->whole, rig, motion, plants, landings, landing_count, begin, i, &w) &&
            !overlaps(out, count, &w))
            out[count++] = w;
        begin = -1;
    }
    return count;
}

int ff_wholes_find(const ff_cut_settings *set, const ff_rig *rig, const ff_motion *motion,
                   const ff_plants *plants, const ff_stand *stands, int stand_count,
                   const ff_landing *landings, int landing_count, ff_whole *out, int capacity)
{
    int count = 0;
    for (int i = 0; i + 1 < stand_count && count < capacity; ++i) {
        ff_whole w = {.first = stands[i].last, .last = stands[i + 1].first, .standing = true};
        if ((w.last - w.first) * motion->frame_time > set->whole.longest) continue;
        w.mode = mode_between(set, rig, motion, plants, landings, landing_count, w.first, w.last);
        if (w.mode >= 0) out[count++] = w;
    }
    count = find_ducks(set, rig, motion, plants, landings, landing_count, out, count, capacity);
    if (count > 1) qsort(out, (size_t)count, sizeof *out, by_first);
    return count;
}
