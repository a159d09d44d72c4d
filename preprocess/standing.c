#include "preprocess/standing.h"

static const double SHORTEST = 0.3;               /* s */
static const double BODY_AT_REST = 0.12;          /* m/s, smoothed root: slow walks keep above 0.3 */
static const double FOOT_AT_REST = 0.25;          /* m/s, ball */
static const double TURN_AT_REST = 25.0 * FF_DEG; /* rad/s */

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

static bool stands(const ff_motion *motion, const ff_plants *plants, int frame)
{
    int n = motion->frame_count, before = frame > 0 ? frame - 1 : 0,
        after = frame + 1 < n ? frame + 1 : n - 1;
    if (after == before) return false;
    double per_s = 1.0 / ((after - before) * motion->frame_time);
    ff_vec3 moved = ff_sub3(motion->root[after], motion->root[before]);
    if (ff_length2(ff_v2(moved.x, moved.y)) * per_s > BODY_AT_REST || fabs(moved.z) * per_s > TURN_AT_REST)
        return false;
    for (int foot = 0; foot < 2; ++foot) {
        if (plants->tracks[2 * frame + foot].ball_speed > FOOT_AT_REST) return false;
        if (ff_plant_at(plants, foot, frame) < 0) return false;
    }
    return true;
}

int ff_stands_find(const ff_motion *motion, const ff_plants *plants, ff_stand *out, int capacity)
{
    int count = 0, begin = -1;
    for (int i = 0; i <= motion->frame_count; ++i) {
        bool here = i < motion->frame_count && stands(motion, plants, i);
        if (here && begin < 0) begin = i;
        if (!here && begin >= 0) {
            if ((i - begin) * motion->frame_time >= SHORTEST && count < capacity)
                out[count++] = (ff_stand){begin, i - 1};
            begin = -1;
        }
    }
    return count;
}
