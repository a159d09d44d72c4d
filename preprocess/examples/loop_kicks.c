/* How much the joints' velocities change at a foot's contact, to compare the cut of a loop with. */
#include "preprocess/examples/loop.h"

/* Mean change of the joints' velocity (m/s) from one frame before to one frame after frame k; velocities are central
 * differences, as at the cut. */
static double change_at(const ff_rig *rig, const ff_example *e, int k)
{
    ff_vec3 at[3][FF_BODY_COUNT];
    int n = e->frame_count;
    for (int i = 0; i < 3; ++i)
        ff_example_pose(rig, e, (k + 2 * (i - 1) + 2 * n) % n, at[i]);
    double sum = 0.0;
    for (int r = 0; r < FF_ROLE_JOINT_COUNT; ++r)
        sum += ff_length3(ff_sub3(ff_add3(at[0][r], at[2][r]), ff_scale3(at[1][r], 2.0)));
    return 0.5 * sum / FF_ROLE_JOINT_COUNT * n / (double)e->record.period;
}

void ff_loop_find_contact_kick(const ff_rig *rig, ff_example *e)
{
    double cut = (double)e->loop.cut, right = (double)e->record.key[2], away = cut - right;
    double from_left = fabs(cut - floor(cut + 0.5)), from_right = fabs(away - floor(away + 0.5));
    double contact = from_left > from_right ? 0.0 : right;
    e->loop.contact_kick = (float)change_at(rig, e, (int)floor(contact * e->frame_count + 0.5));
}
