/* Each example as strips of poses from the side, in front and above, with what closing it took; which kinds of
 * locomotion there are; the semi-procedural clip. */
#include "preprocess/examples/example_judge.h"
#include "preprocess/examples/example_kinds.h"
#include "preprocess/report/pack_read.h"
#include "preprocess/report/report_parts.h"

/* px */
enum { PER_METRE = 52, POSES = 6, TALL = 112, GROUND = 104, ABOVE = 60, STEP = 62, FRONT = 70 };

static const struct chain {
    const char *style;
    int count, at[6];
} body[] = {
    {"r", 4, {FF_ROLE_SHOULDER_R, FF_ROLE_ELBOW_R, FF_ROLE_WRIST_R, FF_ROLE_HAND_R}},
    {"r", 4, {FF_ROLE_HIPS, FF_ROLE_HIP_R, FF_ROLE_KNEE_R, FF_ROLE_ANKLE_R}},
    {"r", 5, {FF_ROLE_ANKLE_R, FF_BODY_HEEL_R, FF_ROLE_BALL_R, FF_ROLE_TOE_R, FF_ROLE_ANKLE_R}},
    {"t", 5, {FF_ROLE_HIPS, FF_ROLE_SPINE, FF_ROLE_CHEST, FF_ROLE_NECK, FF_ROLE_HEAD}},
    {"t", 3, {FF_ROLE_SHOULDER_L, FF_ROLE_CHEST, FF_ROLE_SHOULDER_R}},
    {"l", 4, {FF_ROLE_SHOULDER_L, FF_ROLE_ELBOW_L, FF_ROLE_WRIST_L, FF_ROLE_HAND_L}},
    {"l", 4, {FF_ROLE_HIPS, FF_ROLE_HIP_L, FF_ROLE_KNEE_L, FF_ROLE_ANKLE_L}},
    {"l", 5, {FF_ROLE_ANKLE_L, FF_BODY_HEEL_L, FF_ROLE_BALL_L, FF_ROLE_TOE_L, FF_ROLE_ANKLE_L}},
};

enum { SIDE, FROM_FRONT, TOP };

/* One pose at (x, y) of the picture. */
static void draw_pose(ff_text *page, const ff_vec3 *at, int view, double x, double y)
{
    for (size_t c = 0; c < sizeof body / sizeof *body; ++c) {
        ff_text_add(page, "<polyline class=\"%s\" points=\"", body[c].style);
        for (int k = 0; k < body[c].count; ++k) {
            ff_vec3 p = at[body[c].at[k]];
            double across = view == SIDE ? p.z : -p.x, up = view == TOP ? p.z : p.y;
            ff_text_add(page, "%.1f,%.1f ", x + ff_clamp(across, -2.0, 2.0) * PER_METRE,
                        y - ff_clamp(up, -1.0, 3.0) * PER_METRE);
        }
        ff_text_add(page, "\"/>");
    }
    if (view == TOP) return;
    ff_vec3 head = ff_lerp3(at[FF_ROLE_HEAD], at[FF_ROLE_HEAD_TOP], 0.5);
    ff_text_add(page, "<circle class=\"head\" cx=\"%.1f\" cy=\"%.1f\" r=\"5\"/>",
                x + ff_clamp(view == SIDE ? head.z : -head.x, -2.0, 2.0) * PER_METRE,
                y - ff_clamp(head.y, -1.0, 3.0) * PER_METRE);
}

/* Side views and views from the front over one cycle, and from above where the feet stand along the path. */
static void draw_strips(ff_text *page, const ff_rig *rig, const ff_example *e)
{
    int wide = 2 * POSES * STEP + FRONT + 150;
    ff_text_add(
        page,
        "<svg width=\"%d\" height=\"%d\"><line class=\"ground\" x1=\"0\" x2=\"%d\" y1=\"%d\" y2=\"%d\"/>",
        wide, TALL + 6, 2 * POSES * STEP + FRONT / 2, GROUND, GROUND);
    for (int i = 0; i < POSES; ++i) {
        ff_vec3 at[FF_BODY_COUNT];
        ff_example_pose(rig, e, i * e->frame_count / POSES, at);
        draw_pose(page, at, SIDE, 34.0 + i * STEP, GROUND);
        draw_pose(page, at, FROM_FRONT, 34.0 + (POSES + i) * STEP + FRONT / 2, GROUND);
    }
    double x = 2 * POSES * STEP + FRONT + 75;
    ff_vec3 at[FF_BODY_COUNT];
    ff_example_pose(rig, e, 0, at);
    draw_pose(page, at, TOP, x, ABOVE);
    for (int foot = 0; foot < 2; ++foot) {
        ff_text_add(page, "<polygon class=\"path %s\" points=\"", foot ? "r" : "l");
        for (int k = 0; k < e->frame_count; k += 2)
            ff_text_add(page, "%.1f,%.1f ", x - (double)e->feet[2 * k + foot].ball[1] * PER_METRE,
                        ABOVE - (double)e->feet[2 * k + foot].ball[0] * PER_METRE);
        ff_text_add(page, "\"/>");
    }
    ff_text_add(page, "</svg>");
}

static void draw_example(ff_text *page, const ff_rig *rig, const ff_example *e)
{
    const ff_pack_example *r = &e->record;
    ff_text_add(page, "<div class=\"card example\" style=\"border-top-color:%s\"><b>",
                r->flags & FF_EXAMPLE_DERIVED ? "#f2c14e" : (r->gait == FF_GAIT_RUN ? "#c2571a" : "#2c7a3f"));
    ff_report_text(page, e->name);
    ff_text_add(
        page, "</b> forward %.2f m/s, left %.2f m/s, turns %.0f&deg;/s, cycle %.2f s%s<br>",
        (double)r->v_forward, (double)r->v_left, (double)r->turn_rate / FF_DEG, (double)r->period,
        r->flags & FF_EXAMPLE_DERIVED
            ? "; made up"
            : (r->flags & FF_EXAMPLE_LOOSE ? "; second best, for want of a cycle that closes well" : ""));
    draw_strips(page, rig, e);
    if (!(r->flags & FF_EXAMPLE_DERIVED))
        ff_text_add(page,
                    "<div>cut at %.2f; ends differed by %.1f cm; closing moved a joint by at most %.1f cm, "
                    "left %.2f mm; "
                    "velocities differ by %.0f cm/s at the cut, %.0f at a contact</div>",
                    (double)e->loop.cut, 100.0 * (double)r->seam, 100.0 * (double)e->loop.moved,
                    1000.0 * (double)e->loop.jump, 100.0 * (double)e->loop.cut_kick,
                    100.0 * (double)e->loop.contact_kick);
    ff_text_add(page, "</div>\n");
}

/* --------------------------------------------------------------------------------------------------------- kinds */

static void list_kind(ff_text *page, const ff_pack *pack, const ff_example_kind *kind, double side)
{
    const ff_pack_example *best = NULL;
    double nearest = kind->within;
    for (uint32_t i = 0; i < pack->example_count; ++i) {
        double here = ff_kind_distance(kind, side, &pack->examples[i]);
        if (here > nearest) continue;
        nearest = here;
        best = &pack->examples[i];
    }
    ff_text_add(page, "<tr class=\"kind\"><td>%s%s<td>", kind->name,
                !ff_kind_has_sides(kind) ? "" : (side > 0.0 ? ", left" : ", right"));
    ff_report_text(page, best ? ff_pack_string(pack, best->name) : "missing");
    ff_text_add(page, "<td>%s</tr>\n",
                !best                               ? ""
                : best->flags & FF_EXAMPLE_DERIVED  ? "made up"
                : best->flags & FF_EXAMPLE_MIRRORED ? "mirrored"
                : best->flags & FF_EXAMPLE_LOOSE    ? "second best"
                                                    : "captured");
}

static void list_kinds(ff_text *page, const ff_pack *pack)
{
    ff_text_add(
        page,
        "<table><tr><th>kind of locomotion (the 19 of FbCrowd's database)<th>nearest example<th></tr>\n");
    for (int i = 0; i < FF_EXAMPLE_KINDS; ++i) {
        const ff_example_kind *kind = &ff_example_kinds[i];
        if (!kind->of_paper) continue;
        list_kind(page, pack, kind, 1.0);
        if (ff_kind_has_sides(kind)) list_kind(page, pack, kind, -1.0);
    }
    ff_text_add(page, "</table>\n");
}

static void list_left_out(ff_text *page, const json_t *meta)
{
    size_t i;
    const json_t *entry, *list = json_object_get(json_object_get(meta, "examples"), "left_out");
    if (json_array_size(list) == 0) return;
    ff_text_add(page, "<details><summary>%d cycles left out</summary><ul>", (int)json_array_size(list));
    json_array_foreach(list, i, entry)
    {
        const char *name = json_string_value(json_object_get(entry, "name"));
        const char *why = json_string_value(json_object_get(entry, "why"));
        ff_text_add(page, "<li class=\"cycle\">");
        ff_report_text(page, name ? name : "?");
        ff_text_add(page, ": ");
        ff_report_text(page, why ? why : "");
        ff_text_add(page, "</li>\n");
    }
    ff_text_add(page, "</ul></details>\n");
}

/* --------------------------------------------------------------------------------------------------------- model */

static void describe_model(ff_text *page, const ff_pack *pack)
{
    static const char *const laws[FF_GAIT_LAW_COUNT] = {"lift of the ball", "pitch of the foot",
                                                        "bob of the hips", "sway of the hips"};
    if (pack->gait_count == 0) return;
    const ff_pack_gait *g = pack->gait;
    ff_text_add(page, "<h2>Semi-procedural clip</h2>\n<p>Made of ");
    ff_report_text(page, ff_pack_string(pack, pack->examples[g->example].name));
    ff_text_add(page,
                ": %.2f m/s, cycle %.2f s, stance %.0f %%. Fitted to %u walks: cycle = %.2f s (v / "
                "%.2f)<sup>%.2f</sup> "
                "(off by %.0f ms), stance = %.3f %+.3f (v - %.2f) (off by %.3f). ",
                (double)g->speed, (double)g->period, 100.0 * (double)g->stance, g->walks, (double)g->period,
                (double)g->speed, -(double)g->cadence, 1000.0 * (double)g->period_residual, (double)g->stance,
                (double)g->stance_slope, (double)g->speed, (double)g->stance_residual);
    for (int i = 0; i < FF_GAIT_LAW_COUNT; ++i)
        ff_text_add(page, "%s = clip's (1 %+.2f (step ratio - 1)) (off by %.0f %%); ", laws[i],
                    (double)g->law[i], 100.0 * (double)g->residual[i]);
    ff_text_add(
        page, "balls off the walks' own by %.1f, %.1f, %.1f cm (forward, left, up; root mean square).</p>\n",
        100.0 * (double)g->ball_residual[0], 100.0 * (double)g->ball_residual[1],
        100.0 * (double)g->ball_residual[2]);
}

ff_status ff_report_examples(ff_text *page, const ff_pack *pack, const json_t *meta, ff_error *error)
{
    ff_rig rig;
    ff_status status = FF_OK;
    ff_pack_read_rig(pack, &rig);
    ff_text_add(page, "<h2>Examples</h2>\n");
    list_kinds(page, pack);
    list_left_out(page, meta);
    ff_text_add(page, "<div class=\"cards\">\n");
    for (uint32_t i = 0; i < pack->example_count && status == FF_OK; ++i) {
        ff_example e;
        status = ff_pack_read_example(pack, i, &e, error);
        if (status != FF_OK) break;
        if (!(e.record.flags & FF_EXAMPLE_MIRRORED)) draw_example(page, &rig, &e);
        ff_example_free(&e);
    }
    ff_text_add(page, "</div>\n<p class=\"key\">Poses of a cycle from the side and in front; from above with "
                      "the way of the "
                      "balls. Mirror images are not shown.</p>\n");
    describe_model(page, pack);
    return status;
}
