/* locomotion.c - what a body may move by: walking examples, the semi-procedural clip, running examples; what each can do, and
 * how the clip stands upright (FbCrowd 5; synthesis study, section 5). */
#include "runtime/core/gait/gait_hips.h"
#include "runtime/core/gait/leg_ik.h"

#define TURN_SLOW (135.0 * FF_DEG) /* rad/s, up to SLOW; people would have to hop to turn faster */
#define TURN_QUICK (90.0 * FF_DEG) /* from QUICK on */
#define TURN_ASIDE 0.7             /* of that is lost to the widest side steps: legs would cross */
#define SLOW 0.6                   /* m/s */
#define QUICK 0.9
#define HEIGHT_PHASES 16
#define STANCE_LEAST 0.52 /* of the clip's cycle: both feet must be down for a while, as keys have to rise */
#define STANCE_MOST 0.9
#define MOST_STRETCH 1.4 /* of the clip's own speed: further on its steps are lunges */
#define ROLL 0.01        /* m */
#define EASY 1.1         /* m/s: up to here the longest reach is FF_LEG_REACH ... */
#define HASTY_REACH                                                                                          \
    0.985 /* ... and this at the most: who walks fast straightens the knee too quickly to stop there */

bool ff_locomotion_available(const ff_blend_space *space, ff_locomotion way)
{
    if (way == FF_SEMI_PROCEDURAL) return space->model.clip.gait != NULL;
    return way == FF_BLENDING || (way == FF_RUNNING && space->vertex_count > space->walk_count);
}

/* ------------------------------------------------------------------------------------ the semi-procedural clip */

/* Within an ellipse of velocities, whose direction is kept: that is what this motion is for. */
static ff_rates clamp_model(const ff_clip_model *model, ff_rates target)
{
    double f = target.forward / (target.forward < 0.0 ? FF_MODEL_BACKWARD : model->fastest);
    double l = target.left / FF_MODEL_SIDEWAYS;
    double far = ff_max(1.0, sqrt(f * f + l * l));
    ff_rates out = {target.forward / far, target.left / far, target.turn};
    double speed = sqrt(out.forward * out.forward + out.left * out.left);
    double most = ff_lerp(TURN_SLOW, TURN_QUICK, ff_smooth((speed - SLOW) / (QUICK - SLOW)));
    most *= 1.0 - TURN_ASIDE * fabs(out.left) / FF_MODEL_SIDEWAYS;
    out.turn = ff_clamp(out.turn, -most, most);
    return out;
}

typedef struct grid_axis {
    double low, high;
    int nodes;
} grid_axis;

static const grid_axis axes[3] = {{-FF_MODEL_BACKWARD, FF_MODEL_FORWARD, FF_MODEL_NODES_FORWARD},
                                  {-FF_MODEL_SIDEWAYS, FF_MODEL_SIDEWAYS, FF_MODEL_NODES_LEFT},
                                  {-TURN_SLOW, TURN_SLOW, FF_MODEL_NODES_TURN}};

static double node_value(int axis, int node)
{
    return ff_lerp(axes[axis].low, axes[axis].high, node / (axes[axis].nodes - 1.0));
}

/* The node below a value and how far it is on the way to the next one. */
static int node_below(int axis, double value, double *share)
{
    const grid_axis *a = &axes[axis];
    double at = ff_clamp((value - a->low) / (a->high - a->low), 0.0, 1.0) * (a->nodes - 1);
    int node = (int)at < a->nodes - 2 ? (int)at : a->nodes - 2;
    *share = at - node;
    return node;
}

static double height_at(const ff_clip_model *model, ff_rates rates)
{
    double s[3], sum = 0.0;
    int n[3] = {node_below(0, rates.forward, &s[0]), node_below(1, rates.left, &s[1]),
                node_below(2, rates.turn, &s[2])};
    for (int corner = 0; corner < 8; ++corner) {
        int i = corner & 1, j = corner >> 1 & 1, k = corner >> 2;
        double weight = (i ? s[0] : 1.0 - s[0]) * (j ? s[1] : 1.0 - s[1]) * (k ? s[2] : 1.0 - s[2]);
        sum += weight * (double)model->height[n[0] + i][n[1] + j][n[2] + k];
    }
    return sum;
}

static void set_clip(const ff_clip_model *model, ff_rates rates, ff_blend *out)
{
    ff_blend_clear(out);
    out->vertex[0] = model->vertex;
    out->weight[0] = 1.0;
    out->rates = rates;
    out->period = ff_gait_model_period(&model->clip, rates);
    out->stance = ff_clamp(ff_gait_model_stance(&model->clip, rates), STANCE_LEAST, STANCE_MOST);
    out->way = FF_SEMI_PROCEDURAL;
}

/* How high the hips may be for this foot, if it stands, to be within reach. */
static double most_height(const ff_blend_space *space, const ff_cursor *cursor, int foot, double reach)
{
    const ff_body_frame *body = &space->body;
    ff_foot_sample at = ff_sample_foot(space, cursor, foot);
    ff_vec3 hips = ff_sample_hips(space, cursor);
    ff_quat turn = ff_sample_rotation(space, cursor, FF_JOINT_HIPS);
    ff_vec3 hip = ff_add3(ff_v3(hips.y, hips.z, hips.x),
                          ff_quat_rotate(turn, body->offset[FF_JOINT_HIP_L + foot * FF_JOINT_LEG_STRIDE]));
    ff_foothold ball = {at.forward, at.left, at.height, at.yaw};
    ff_vec3 ankle = ff_gait_ankle(body, foot, ball, ff_gait_foot_rotation(at.yaw, at.pitch));
    return -ff_gait_lack(hip, ankle, reach * (body->thigh[foot] + body->shank[foot]));
}

static double find_height(const ff_blend_space *space, ff_rates rates)
{
    ff_blend clip;
    double least = 1e9, haste = ff_smooth((fabs(rates.forward) - EASY) / (space->model.fastest - EASY));
    double reach = ff_lerp(FF_LEG_REACH, HASTY_REACH, haste);
    set_clip(&space->model, rates, &clip);
    for (int foot = 0; foot < 2; ++foot)
        for (int k = 0; k <= HEIGHT_PHASES; ++k) {
            double fraction = clip.stance * k / HEIGHT_PHASES + 0.5 * foot;
            ff_cursor cursor = ff_cursor_of_clip(space, &clip, fraction - floor(fraction));
            least = ff_min(least, most_height(space, &cursor, foot, reach));
        }
    return least;
}

/* Mean rotation of a joint over the cycle, on the hemisphere of its first pose. */
static ff_quat mean_rotation(const ff_blend_space *space, int32_t vertex, int joint)
{
    ff_quat sum = {0.0, 0.0, 0.0, 0.0};
    uint32_t frames = space->vertices[vertex].frame_count;
    for (uint32_t k = 0; k < frames; ++k) {
        ff_cursor cursor = ff_cursor_of_vertex(space, vertex, (double)k / frames);
        ff_quat q = ff_sample_rotation(space, &cursor, joint);
        double sign = ff_quat_dot(q, sum) < 0.0 ? -1.0 : 1.0;
        sum = (ff_quat){sum.x + sign * q.x, sum.y + sign * q.y, sum.z + sign * q.z, sum.w + sign * q.w};
    }
    return ff_quat_unit(sum);
}

/* As long as the example holds its balls, but no longer than until the clip's has risen by ROLL: then the foot rolls over the
 * toe. Held on, it would fall so far behind that the leg gets too short for it (at 1.8 m/s 7 cm). */
static void find_hold(const ff_blend_space *space, ff_clip_model *model)
{
    const ff_blend_vertex *vertex = &space->vertices[model->vertex];
    double stance = ff_vertex_fraction(space, model->vertex, 3.0);
    double start = ff_vertex_fraction(space, model->vertex, vertex->lock_start[0]);
    double end = ff_vertex_fraction(space, model->vertex, vertex->lock_start[0] + vertex->lock_length[0]);
    model->hold[0] = ff_clamp(start / stance, 0.0, 0.4);
    model->hold[1] = ff_clamp(end / stance, 0.6, 0.98);
    for (int i = 0; i < FF_GAIT_SAMPLES; ++i) {
        double share = (double)i / FF_GAIT_SAMPLES / (double)model->clip.gait->stance;
        if (share > 0.6 && share < model->hold[1] && (double)model->clip.path[i].lift > ROLL)
            model->hold[1] = share;
    }
}

/* The vertex that shows the clip's example, -1 if there is none to walk with. */
static int32_t clip_vertex(const ff_blend_space *space, const ff_pack_gait *gait)
{
    for (uint32_t v = 0; v < space->walk_count; ++v)
        if (space->vertices[v].example == gait->example && !space->vertices[v].idle) return (int32_t)v;
    return -1;
}

void ff_clip_model_make(ff_blend_space *space)
{
    const ff_pack *pack = space->pack;
    ff_clip_model *model = &space->model;
    if (pack->gait_count == 0) return;
    model->vertex = clip_vertex(space, pack->gait);
    if (model->vertex < 0) return;
    model->clip = (ff_gait_model){pack->gait, pack->gait_path};
    model->fastest = ff_min(FF_MODEL_FORWARD, MOST_STRETCH * (double)pack->gait->speed);
    find_hold(space, model);
    for (int joint = 0; joint < FF_JOINT_HIP_L; ++joint)
        model->mean[joint] = mean_rotation(space, model->vertex, joint);
    for (int i = 0; i < FF_MODEL_NODES_FORWARD; ++i)
        for (int j = 0; j < FF_MODEL_NODES_LEFT; ++j)
            for (int k = 0; k < FF_MODEL_NODES_TURN; ++k) {
                ff_rates rates = {node_value(0, i), node_value(1, j), node_value(2, k)};
                model->height[i][j][k] = (float)find_height(space, rates);
            }
}

/* ------------------------------------------------------------------------------------------------------ running */

static double slowest_run(const ff_blend_space *space)
{
    double least = 1e9;
    for (uint32_t v = space->walk_count; v < space->vertex_count; ++v)
        least = ff_min(least, space->vertices[v].rates.forward);
    return least;
}

/* Who is slower than the slowest run is on the way to it or to a walk: for those few steps the plants, which are placed for
 * the root as it moves, take up the rest. */
static ff_rates clamp_run(const ff_blend_space *space, ff_rates target)
{
    ff_blend blend;
    ff_rates asked = {ff_max(target.forward, slowest_run(space)), 0.0, target.turn};
    ff_blend_find_in(space, FF_GAIT_RUN, asked, &blend);
    return (ff_rates){ff_clamp(target.forward, 0.0, blend.rates.forward), 0.0, blend.rates.turn};
}

/* ------------------------------------------------------------------------------------------------------ any */

ff_rates ff_locomotion_clamp(const ff_blend_space *space, ff_locomotion way, ff_rates target)
{
    if (way == FF_SEMI_PROCEDURAL) return clamp_model(&space->model, target);
    if (way == FF_RUNNING) return clamp_run(space, target);
    return ff_blend_clamp_turn(space, target);
}

void ff_locomotion_find(const ff_blend_space *space, ff_locomotion way, ff_rates target, ff_blend *out)
{
    if (way != FF_SEMI_PROCEDURAL) {
        ff_blend_find_in(space, way == FF_RUNNING ? FF_GAIT_RUN : FF_GAIT_WALK, target, out);
        return;
    }
    ff_rates rates = clamp_model(&space->model, target);
    set_clip(&space->model, rates, out);
    out->hips = height_at(&space->model, rates);
}
