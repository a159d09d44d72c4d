#include "preprocess/report/report_parts.h"

#include "runtime/core/pack/joints.h"

/* Side view, px: the way the person faces at t_0 is to the right. */
enum { PER_METRE = 62, POSES = 5, TALL = 132, GROUND = 120, MARGIN = 34 };
/* Nothing is drawn farther from the support foot than this, m. */
static const double FARTHEST = 6.0;

/* What is drawn of the body, from back to front: joint or point chains. */
enum { TIP = 100 }; /* TIP + kind = the point of that kind */
typedef struct chain {
    const char *style;
    int count;
    int at[6];
} chain;

static const chain body[] = {
    {"r", 4, {FF_JOINT_SHOULDER_R, FF_JOINT_ELBOW_R, FF_JOINT_WRIST_R, TIP + FF_POINT_HAND_R}},
    {"r", 4, {FF_JOINT_HIPS, FF_JOINT_HIP_R, FF_JOINT_KNEE_R, FF_JOINT_ANKLE_R}},
    {"r",
     5,
     {FF_JOINT_ANKLE_R, TIP + FF_POINT_HEEL_R, FF_JOINT_BALL_R, TIP + FF_POINT_TOE_R, FF_JOINT_ANKLE_R}},
    {"t", 5, {FF_JOINT_HIPS, FF_JOINT_SPINE, FF_JOINT_CHEST, FF_JOINT_NECK, FF_JOINT_HEAD}},
    {"t", 3, {FF_JOINT_SHOULDER_L, FF_JOINT_CHEST, FF_JOINT_SHOULDER_R}},
    {"l", 4, {FF_JOINT_SHOULDER_L, FF_JOINT_ELBOW_L, FF_JOINT_WRIST_L, TIP + FF_POINT_HAND_L}},
    {"l", 4, {FF_JOINT_HIPS, FF_JOINT_HIP_L, FF_JOINT_KNEE_L, FF_JOINT_ANKLE_L}},
    {"l",
     5,
     {FF_JOINT_ANKLE_L, TIP + FF_POINT_HEEL_L, FF_JOINT_BALL_L, TIP + FF_POINT_TOE_L, FF_JOINT_ANKLE_L}},
};

static ff_vec3 place(const ff_pack *pack, const ff_vec3 *positions, int at)
{
    if (at < TIP) return positions[at];
    for (uint32_t p = 0; p < pack->point_count; ++p)
        if (pack->points[p].kind == (uint32_t)(at - TIP)) return positions[pack->joint_count + p];
    return positions[0];
}

/* The side view of one action. */
typedef struct side_view {
    ff_text *page;
    const ff_pack *pack;
    ff_vec2 axis, origin;
    double left; /* m, of the picture's left edge */
} side_view;

static double along(const side_view *v, ff_vec3 p)
{
    return ff_clamp(ff_dot2(v->axis, ff_sub2(ff_plane(p), v->origin)), -FARTHEST, FARTHEST);
}

static void draw_body(const side_view *v, uint32_t stream, double seconds, double opacity)
{
    ff_vec3 at[FF_PACK_MAX_JOINTS + FF_POINT_COUNT * 4];
    ff_report_pose(v->pack, stream, seconds, at);
    ff_text_add(v->page, "<g opacity=\"%.2f\">", opacity);
    for (size_t c = 0; c < sizeof body / sizeof *body; ++c) {
        ff_text_add(v->page, "<polyline class=\"%s\" points=\"", body[c].style);
        for (int k = 0; k < body[c].count; ++k) {
            ff_vec3 p = place(v->pack, at, body[c].at[k]);
            ff_text_add(v->page, "%.1f,%.1f ", MARGIN + (along(v, p) - v->left) * PER_METRE,
                        GROUND - ff_clamp(p.y, -1.0, 4.0) * PER_METRE);
        }
        ff_text_add(v->page, "\"/>");
    }
    ff_vec3 head =
        ff_lerp3(place(v->pack, at, FF_JOINT_HEAD), place(v->pack, at, TIP + FF_POINT_HEAD_TOP), 0.5);
    ff_text_add(v->page, "<circle class=\"head\" cx=\"%.1f\" cy=\"%.1f\" r=\"6\"/></g>",
                MARGIN + (along(v, head) - v->left) * PER_METRE,
                GROUND - ff_clamp(head.y, -1.0, 4.0) * PER_METRE);
}

static void draw_foot_mark(const side_view *v, double at, uint32_t foot, const char *what)
{
    ff_text_add(v->page, "<path class=\"mark %s\" d=\"M%.1f %d l4 7 h-8 z\"><title>%s</title></path>",
                foot ? "r" : "l", MARGIN + (at - v->left) * PER_METRE, GROUND + 2, what);
}

static void describe(ff_text *page, const ff_pack_action *a)
{
    ff_text_add(page, "<div>%s, %.2f s, %.2f m/s<br>step %.2f m, width %.2f m<br>", ff_report_mode(a->mode),
                (double)a->duration, (double)a->speed, (double)a->step_length, (double)a->step_width);
    if (a->flags & FF_ACTION_ALPHA_UNDEFINED)
        ff_text_add(page, "&alpha; -, ");
    else
        ff_text_add(page, "&alpha; %.0f&deg;, ", (double)a->alpha / FF_DEG);
    ff_text_add(page, "&theta; %.0f&deg;, %.1f J/kg", (double)a->theta / FF_DEG, (double)a->energy);
    if (a->flight[0] >= 0.0f)
        ff_text_add(page, ", flight %.0f ms", 1000.0 * ((double)a->flight[1] - (double)a->flight[0]));
    ff_text_add(page, "</div>");
}

static void draw_action(ff_text *page, const ff_pack *pack, const ff_pack_clip *clip, uint32_t index)
{
    const ff_pack_action *a = &pack->actions[index];
    double first = (double)a->t_0 - (double)clip->time_offset,
           last = (double)a->t_end - (double)clip->time_offset;
    ff_root_frame root;
    ff_pack_sample(pack, clip->stream, first, 0, &root, NULL, NULL, NULL);
    /* The support foot's ball is the origin: root_start leads from it to the root. */
    ff_vec2 axis = ff_fwd2(root.heading);
    ff_vec2 back = ff_from_frame2(axis, ff_v2((double)a->root_start[0], (double)a->root_start[1]));
    side_view v = {page, pack, axis, ff_sub2(root.position, back), 0.0};
    double from = (double)a->root_start[0], to = (double)a->root_end[0];
    v.left = ff_max(-FARTHEST, ff_min(from, to) - 0.35);
    double right = ff_min(FARTHEST, ff_max(from, to) + 0.35);
    double width = 2.0 * MARGIN + (right - v.left) * PER_METRE;
    ff_text_add(page, "<div class=\"card\" style=\"border-top-color:%s\"><b>%u</b> stands %s, swings %s",
                ff_report_colour(a->mode), index, a->support ? "right" : "left", a->swing ? "right" : "left");
    ff_text_add(
        page,
        "<svg width=\"%.0f\" height=\"%d\"><line class=\"ground\" x1=\"0\" x2=\"%.0f\" y1=\"%d\" y2=\"%d\"/>",
        width, TALL, width, GROUND, GROUND);
    for (int k = 0; k < POSES; ++k) {
        draw_body(&v, clip->stream, ff_lerp(first, last, k / (POSES - 1.0)),
                  k == 0 || k == POSES - 1 ? 1.0 : 0.28);
    }
    draw_foot_mark(&v, 0.0, a->support, "support foot");
    draw_foot_mark(&v, (double)a->land[0], a->swing, "where the swing foot lands");
    ff_text_add(page, "</svg>");
    describe(page, a);
    ff_text_add(page, "</div>\n");
}

void ff_report_steps(ff_text *page, const ff_pack *pack, const ff_pack_clip *clip)
{
    if (clip->action_count == 0) return;
    ff_text_add(page, "<div class=\"cards\">\n");
    for (uint32_t i = 0; i < clip->action_count; ++i)
        draw_action(page, pack, clip, clip->first_action + i);
    ff_text_add(page, "</div>\n");
}
