#include "preprocess/motion/standing.h"

int ff_plant_at(const ff_plants *plants, int foot, int frame)
{
    for (int i = 0; i < plants->count; ++i)
        if (plants->items[i].foot == foot && plants->items[i].start <= frame && frame <= plants->items[i].end)
            return i;
    return -1;
}

double ff_hips_height(const ff_motion *motion, const ff_plants *plants, int frame)
{
    double level = 0.0;
    bool down = false;
    for (int foot = 0; foot < 2; ++foot) {
        int plant = ff_plant_at(plants, foot, frame);
        if (plant < 0) continue;
        level = down ? ff_min(level, plants->items[plant].level) : plants->items[plant].level;
        down = true;
    }
    return motion->hips[frame].z - level * motion->scale;
}

/* The smoothed root of slow walks keeps above 0.3 m/s: what is called standing is well below. */
static bool stands(const ff_standing_settings *set, const ff_motion *motion, const ff_plants *plants,
                   int frame)
{
    int n = motion->frame_count, before = frame > 0 ? frame - 1 : 0,
        after = frame + 1 < n ? frame + 1 : n - 1;
    if (after == before) return false;
    double per_s = 1.0 / ((after - before) * motion->frame_time);
    ff_vec3 moved = ff_sub3(motion->root[after], motion->root[before]);
    if (ff_length2(ff_v2(moved.x, moved.y)) * per_s > set->body || fabs(moved.z) * per_s > set->turn * FF_DEG)
        return false;
    for (int foot = 0; foot < 2; ++foot) {
        if (plants->tracks[2 * frame + foot].ball_speed > set->foot) return false;
        if (ff_plant_at(plants, foot, frame) < 0) return false;
    }
    return true;
}

int ff_stands_find(const ff_standing_settings *settings, const ff_motion *motion, const ff_plants *plants,
                   ff_stand *out, int capacity)
{
    int count = 0, begin = -1;
    for (int i = 0; i <= motion->frame_count; ++i) {
        bool here = i < motion->frame_count && stands(settings, motion, plants, i);
        if (here && begin < 0) begin = i;
        if (!here && begin >= 0) {
            if ((i - begin) * motion->frame_time >= settings->shortest && count < capacity)
                out[count++] = (ff_stand){begin, i - 1};
            begin = -1;
        }
    }
    return count;
}
