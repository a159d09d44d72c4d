#include "preprocess/report/report_parts.h"

#include "preprocess/examples/hull.h"

/* Forward is up, left is left; px. */
enum { SIDE = 460, MARGIN = 40 };

typedef struct plot {
    ff_text *page;
    double reach; /* m/s at the edge */
} plot;

static ff_vec2 at(const plot *p, double forward, double left)
{
    double half = SIDE / 2.0, scale = (half - MARGIN) / p->reach;
    return ff_v2(half - left * scale, half - forward * scale); /* a = px across, b = px down */
}

static ff_vec2 velocity_of(const ff_pack_example *e)
{
    return ff_hull_velocity(ff_length2(ff_v2((double)e->v_forward, (double)e->v_left)), (double)e->turn_rate);
}

static double find_reach(const ff_pack *pack)
{
    double reach = 1.0;
    for (uint32_t i = 0; i < pack->hull_count; ++i)
        reach = ff_max(reach, ff_length2(ff_v2((double)pack->hull[i].f, (double)pack->hull[i].l)));
    for (uint32_t i = 0; i < pack->example_count; ++i)
        reach = ff_max(reach, ff_length2(velocity_of(&pack->examples[i])));
    return 1.1 * reach;
}

static void draw_grid(const plot *p)
{
    for (int k = 1; k <= (int)p->reach; ++k) {
        ff_vec2 c = at(p, 0.0, 0.0), top = at(p, k, 0.0);
        ff_text_add(p->page,
                    "<circle class=\"grid\" cx=\"%.1f\" cy=\"%.1f\" r=\"%.1f\"/><text x=\"%.1f\" "
                    "y=\"%.1f\">%d m/s</text>",
                    c.a, c.b, c.b - top.b, c.a + 3, top.b - 2, k);
    }
    ff_text_add(p->page,
                "<line class=\"grid\" x1=\"%d\" x2=\"%d\" y1=\"%d\" y2=\"%d\"/><line class=\"grid\" "
                "x1=\"%d\" x2=\"%d\" y1=\"%d\" y2=\"%d\"/>",
                SIDE / 2, SIDE / 2, MARGIN / 2, SIDE - MARGIN / 2, MARGIN / 2, SIDE - MARGIN / 2, SIDE / 2,
                SIDE / 2);
    ff_text_add(p->page,
                "<text class=\"mid\" x=\"%d\" y=\"12\">forward</text><text x=\"2\" y=\"%d\">left</text>",
                SIDE / 2, SIDE / 2 - 4);
}

static void draw_corners(const plot *p, const ff_pack *pack)
{
    ff_text_add(p->page, "<polygon class=\"hull\" points=\"");
    for (uint32_t i = 0; i < pack->hull_count; ++i) {
        ff_vec2 c = at(p, (double)pack->hull[i].f, (double)pack->hull[i].l);
        ff_text_add(p->page, "%.1f,%.1f ", c.a, c.b);
    }
    ff_text_add(p->page, "\"/>");
}

static void draw_examples(const plot *p, const ff_pack *pack)
{
    for (uint32_t i = 0; i < pack->example_count; ++i) {
        const ff_pack_example *e = &pack->examples[i];
        ff_vec2 v = velocity_of(e), c = at(p, v.a, v.b);
        const char *kind = e->flags & FF_EXAMPLE_IDLE ? "idle" : (e->gait == FF_GAIT_RUN ? "run" : "walk");
        ff_text_add(p->page, "<circle class=\"%s%s\" cx=\"%.1f\" cy=\"%.1f\" r=\"4\"><title>", kind,
                    e->flags & (FF_EXAMPLE_MIRRORED | FF_EXAMPLE_DERIVED) ? " made" : "", c.a, c.b);
        ff_report_text(p->page, ff_pack_string(pack, e->name));
        ff_text_add(p->page, ": forward %.2f m/s, left %.2f m/s, turns %.2f rad/s</title></circle>",
                    (double)e->v_forward, (double)e->v_left, (double)e->turn_rate);
    }
}

static void list_examples(ff_text *page, const ff_pack *pack)
{
    ff_text_add(page, "<table><tr><th>example<th>gait<th>forward m/s<th>left m/s<th>turns rad/s<th>cycle "
                      "s<th>seam cm</tr>\n");
    for (uint32_t i = 0; i < pack->example_count; ++i) {
        const ff_pack_example *e = &pack->examples[i];
        ff_text_add(page, "<tr><td>");
        ff_report_text(page, ff_pack_string(pack, e->name));
        ff_text_add(page, "<td>%s<td>%.2f<td>%.2f<td>%.2f<td>%.2f<td>%.1f</tr>\n",
                    e->flags & FF_EXAMPLE_IDLE ? "stand" : (e->gait == FF_GAIT_RUN ? "run" : "walk"),
                    (double)e->v_forward, (double)e->v_left, (double)e->turn_rate, (double)e->period,
                    100.0 * (double)e->seam);
    }
    ff_text_add(page, "</table>\n");
}

void ff_report_hull(ff_text *page, const ff_pack *pack)
{
    plot p = {page, find_reach(pack)};
    ff_text_add(page, "<h2>Velocity hull</h2>\n<div class=\"row\"><svg width=\"%d\" height=\"%d\">", SIDE,
                SIDE);
    draw_corners(&p, pack);
    draw_grid(&p);
    draw_examples(&p, pack);
    ff_text_add(page, "</svg>\n");
    list_examples(page, pack);
    ff_text_add(page, "</div>\n<p class=\"key\">Each point is an example: its speed, turned by its turn rate "
                      "times one second "
                      "(FbCrowd, figure 3 and equations 2 to 5). <span style=\"color:#2c7a3f\">walks</span>, "
                      "<span style=\"color:#c2571a\">runs</span>; hollow: mirrored or derived. ");
    ff_text_add(page, "Agents may choose velocities inside the line of %u corners.</p>\n", pack->hull_count);
}
