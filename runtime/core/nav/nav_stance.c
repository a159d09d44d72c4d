#include "runtime/core/nav/nav_stance.h"

#define PIVOT (40.0 * FF_DEG)
#define SWING_TIME 0.4 /* s, tau_bm */
#define GATE 0.3       /* m/s */
#define EASE 0.1       /* s */

ff_vec2 ff_stance_normal(const ff_stance *stance)
{
    double side = stance->foot == 0 ? 1.0 : -1.0;
    return ff_scale2(ff_left2(ff_fwd2(stance->heading + side * PIVOT)), side);
}

double ff_stance_room(const ff_stance *stance, ff_vec2 position, double radius)
{
    double reach = ff_dot2(ff_stance_normal(stance), ff_sub2(stance->ball, position));
    return ff_max(0.0, reach - radius) / SWING_TIME;
}

uint32_t ff_stance_line(const ff_stance *stance, ff_vec2 position, double radius, ff_vec2 velocity,
                        ff_vec2 command, double step, ff_stance_memory *memory, ff_line *lines,
                        uint32_t count)
{
    uint32_t foot = (uint32_t)(stance->foot + 1);
    if (ff_dot2(velocity, velocity) < GATE * GATE) foot = 0;
    if (foot != memory->foot) *memory = (ff_stance_memory){.foot = foot};
    if (foot == 0) return count;
    memory->ease = ff_min(memory->ease + step / EASE, 1.0);
    ff_vec2 normal = ff_stance_normal(stance);
    double room = ff_stance_room(stance, position, radius);
    room += (1.0 - memory->ease) * ff_max(ff_dot2(command, normal) - room, 0.0);
    lines[count] = (ff_line){ff_scale2(normal, room), ff_left2(normal), 1.0};
    return count + 1;
}
