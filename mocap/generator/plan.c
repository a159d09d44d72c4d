#include "mocap/generator/plan.h"
#include "mocap/generator/curves.h"
#include "mocap/generator/skeleton.h"
#include "runtime/core/base/memory.h"

#include <stdlib.h>

#define STAND_WIDTH 0.17  /* m between the balls of someone who stands */
#define STAND_AHEAD 0.100 /* m, the balls in front of the hips then */
#define LONG_AGO 30.0     /* s: a stand begins and ends this far outside the clip */

/* ------------------------------------------------------------------------------------------ interpolation */

double ff_hermite(double u, double p0, double p1, double m0, double m1)
{
    double v = 1.0 - u;
    return p0 * v * v * (1.0 + 2.0 * u) + p1 * u * u * (3.0 - 2.0 * u) + m0 * u * v * v - m1 * u * u * v;
}

static double slope_at(const double *x, const double *y, int count, int i)
{
    if (i == 0 || i == count - 1) return 0.0;
    double h0 = x[i] - x[i - 1], h1 = x[i + 1] - x[i];
    double d0 = (y[i] - y[i - 1]) / h0, d1 = (y[i + 1] - y[i]) / h1;
    if (d0 * d1 <= 0.0) return 0.0;
    double w0 = 2.0 * h1 + h0, w1 = h1 + 2.0 * h0;
    return (w0 + w1) / (w0 / d0 + w1 / d1);
}

double ff_monotone(const double *x, const double *y, int count, double at)
{
    if (count < 1) return 0.0;
    if (at <= x[0]) return y[0];
    if (at >= x[count - 1]) return y[count - 1];
    int i = 0;
    while (at > x[i + 1])
        ++i;
    double h = x[i + 1] - x[i], u = (at - x[i]) / h;
    double m0 = slope_at(x, y, count, i) * h, m1 = slope_at(x, y, count, i + 1) * h;
    return ff_hermite(u, y[i], y[i + 1], m0, m1);
}

ff_gesture ff_plan_gesture(const ff_plan *plan, double t)
{
    ff_gesture now = {.t = t};
    int n = plan->gesture_count, i = 0;
    if (n < 2) return now;
    const ff_gesture *g = plan->gestures;
    double x[FF_PLAN_MAX_KNOTS] = {0}, bend[FF_PLAN_MAX_KNOTS] = {0}, arms[FF_PLAN_MAX_KNOTS] = {0};
    for (int k = 0; k < n; ++k) {
        x[k] = g[k].t;
        bend[k] = g[k].bend;
        arms[k] = g[k].arms;
    }
    now.bend = ff_monotone(x, bend, n, t);
    now.arms = ff_monotone(x, arms, n, t);
    t = ff_clamp(t, x[0], x[n - 1]);
    while (i < n - 2 && t > x[i + 1])
        ++i;
    double h = x[i + 1] - x[i];
    now.rise = ff_hermite((t - x[i]) / h, g[i].rise, g[i + 1].rise, g[i].rate * h, g[i + 1].rate * h);
    return now;
}

static ff_rate_knot rates_at(const ff_plan *plan, double t)
{
    double x[FF_PLAN_MAX_KNOTS] = {0}, y[3][FF_PLAN_MAX_KNOTS] = {{0}};
    for (int i = 0; i < plan->knot_count; ++i) {
        const ff_rate_knot *k = &plan->knots[i];
        x[i] = k->t;
        y[0][i] = k->forward;
        y[1][i] = k->left;
        y[2][i] = k->turn;
    }
    int n = plan->knot_count;
    return (ff_rate_knot){t, ff_monotone(x, y[0], n, t), ff_monotone(x, y[1], n, t),
                          ff_monotone(x, y[2], n, t)};
}

/* --------------------------------------------------------------------------------------------------- root */

ff_vec2 ff_plan_to_world(const ff_root *root, ff_vec2 local)
{
    return ff_add2(root->position, ff_from_frame2(ff_fwd2(root->heading), local));
}

ff_vec2 ff_plan_to_local(const ff_root *root, ff_vec2 world)
{
    return ff_to_frame2(ff_fwd2(root->heading), ff_sub2(world, root->position));
}

/* Midpoint rule; with constant rates each short arc's chord is off by less than a nanometre. */
static bool integrate(ff_plan *plan)
{
    plan->root_count = (int)((plan->end - plan->begin) * FF_PLAN_RATE) + 2;
    plan->roots = ff_calloc((size_t)plan->root_count, sizeof *plan->roots);
    if (!plan->roots) return false;
    const double dt = 1.0 / FF_PLAN_RATE;
    ff_root root = {{0.0, 0.0}, 0.0, 0.0, 0.0, 0.0};
    for (int i = 0; i < plan->root_count; ++i) {
        double t = plan->begin + i * dt;
        ff_rate_knot now = rates_at(plan, t), mid = rates_at(plan, t + 0.5 * dt);
        root.forward = now.forward;
        root.left = now.left;
        root.turn = now.turn;
        plan->roots[i] = root;
        ff_vec2 fwd = ff_fwd2(root.heading + 0.5 * dt * mid.turn);
        root.position = ff_madd2(root.position, ff_from_frame2(fwd, ff_v2(mid.forward, mid.left)), dt);
        root.heading += dt * mid.turn;
    }
    return true;
}

ff_root ff_plan_root(const ff_plan *plan, double t)
{
    double x = ff_clamp((t - plan->begin) * FF_PLAN_RATE, 0.0, plan->root_count - 1.000001);
    int i = (int)x;
    double u = x - i;
    const ff_root *p = &plan->roots[i], *q = &plan->roots[i + 1];
    ff_root root;
    root.position = ff_madd2(p->position, ff_sub2(q->position, p->position), u);
    root.heading = ff_lerp(p->heading, q->heading, u);
    root.forward = ff_lerp(p->forward, q->forward, u);
    root.left = ff_lerp(p->left, q->left, u);
    root.turn = ff_lerp(p->turn, q->turn, u);
    return root;
}

double ff_plan_phase(const ff_plan *plan, double t)
{
    const ff_contact *c = plan->contacts;
    int n = plan->contact_count;
    double first = c[0].foot == 0 ? 0.0 : 0.5;
    if (t <= c[0].t || n < 3) return first + 0.5 * (t - c[0].t) / (c[1].t - c[0].t);
    int i = 0;
    while (i < n - 2 && t > c[i + 1].t)
        ++i;
    double linear = first + 0.5 * (i + (t - c[i].t) / (c[i + 1].t - c[i].t));
    if (i == 0 || i == n - 2) return linear;
    const double x[4] = {c[i - 1].t, c[i].t, c[i + 1].t, c[i + 2].t};
    const double y[4] = {-0.5, 0.0, 0.5, 1.0};
    return first + 0.5 * i + ff_monotone(x, y, 4, t);
}

/* --------------------------------------------------------------------------------------------- footprints */

/* Half the distance between the feet's tracks. People who step sideways keep the feet apart by what the trailing foot
 * closes in half a cycle (synthesis study, section 5), less so the longer the feet are apart fore and aft. */
static double half_width(const ff_plan *plan, const ff_root *root, double step_time)
{
    double speed = sqrt(root->forward * root->forward + root->left * root->left);
    double usual = 0.5 * ff_usual_width(speed, plan->style.run);
    double fore = fabs(root->forward) * step_time;
    double keep = 1.0 - ff_smooth((fore - 0.22) / 0.30);
    double side = 0.5 * (0.12 + fabs(root->left) * step_time) - usual;
    double turning = 0.5 * 0.15 - usual; /* turning on the spot: feet as apart as in a stand */
    double extra = ff_max(0.0, side) * ff_smooth(fabs(root->left) / 0.15) * (0.80 + 0.20 * keep);
    double spot = ff_max(0.0, turning) * ff_smooth(fabs(root->turn) / 0.8) * keep;
    return usual + ff_max(extra, spot) + 0.5 * plan->style.widen;
}

static void place(const ff_plan *plan, ff_footing *footing, int foot, double at, double step_time)
{
    ff_root root = ff_plan_root(plan, at);
    double side = foot == 0 ? 1.0 : -1.0;
    double speed = sqrt(root.forward * root.forward + root.left * root.left);
    double ahead = plan->style.run ? -0.075 : ff_lerp(STAND_AHEAD, 0.009, ff_smooth(fabs(root.forward)));
    /* the body leans into a turn by 1.15 times the angle of v * turn rate over g (gait facts): feet outside */
    double outside = -1.15 * root.forward * root.turn / 9.81 * 0.9 * FF_BODY_LEG;
    ff_vec2 local = ff_v2(ahead, side * half_width(plan, &root, step_time) + outside);
    footing->ball = ff_plan_to_world(&root, local);
    footing->yaw = root.heading + side * plan->style.toe_out;
    footing->speed = speed;
}

static void place_stand(const ff_plan *plan, ff_footing *footing, int foot, double at)
{
    ff_root root = ff_plan_root(plan, at);
    double side = foot == 0 ? 1.0 : -1.0;
    footing->ball =
        ff_plan_to_world(&root, ff_v2(STAND_AHEAD, side * 0.5 * (STAND_WIDTH + plan->style.widen)));
    footing->yaw = root.heading + side * (plan->style.toe_out + 2.0 * FF_DEG);
}

/* Pitch of the foot at both ends of a stance: the fits and band means of the gait facts in forward walking; a foot
 * that steps sideways or turns lands flat and hardly rolls. */
static void set_pitch(const ff_plan *plan, ff_footing *footing, const ff_root *root)
{
    double v = ff_max(0.0, root->forward), all = sqrt(v * v + 0.30 * root->left * root->left);
    if (plan->style.run) {
        footing->pitch_contact = 9.0 * FF_DEG;
        footing->pitch_release = -42.0 * FF_DEG;
        return;
    }
    double heel = ff_smooth(v / 0.5);
    footing->pitch_contact = heel * ff_clamp(8.5356 + 12.6893 * v, 0.0, 27.0) * FF_DEG;
    double size = ff_clamp(0.42 + 0.58 * (all + 0.08 * fabs(root->turn)) / 1.1, 0.42, 1.0);
    footing->pitch_release = -44.0 * FF_DEG * size;
}

/* Times of the stance between contact and the other foot's next contact, step_time later. */
static void set_times(const ff_plan *plan, ff_footing *footing, double contact, double step_time)
{
    const ff_plan_style *style = &plan->style;
    double stride = 2.0 * step_time;
    double stance = ff_usual_stance(footing->speed, style->run);
    if (!style->run) /* on the spot feet are quickly set over */
        stance = ff_lerp(0.71, stance, ff_smooth((footing->speed - 0.15) / 0.2));
    double flat = (style->run ? 0.043 : (style->backward ? 0.035 : 0.075)) *
                  ff_min(1.0, footing->pitch_contact / ((style->run ? 9.0 : 20.0) * FF_DEG));
    double push = style->run ? 0.215 : 0.25;
    push *= sqrt(-footing->pitch_release / ((style->run ? 42.0 : 44.0) * FF_DEG));
    footing->contact = contact;
    footing->flat = contact + flat * stride;
    footing->toe_off = contact + stance * stride;
    double rolls =
        ff_smooth(footing->pitch_contact / (15.0 * FF_DEG)); /* a foot that lands flat leaves at once */
    double drag = style->run ? 0.09 * stride : ff_min(0.02 * stride + 0.03 * rolls, 0.055 * stride);
    if (style->backward) drag = (0.02 + 0.015 * rolls) * stride;
    footing->release = footing->toe_off - drag;
    footing->heel_off = footing->toe_off - push * stride;
}

static void add_footing(ff_plan *plan, int index)
{
    const ff_contact *c = &plan->contacts[index];
    int n = plan->contact_count;
    double step_time =
        index + 1 < n ? plan->contacts[index + 1].t - c->t : c->t - plan->contacts[index - 1].t;
    ff_footing *footing = &plan->footings[c->foot][plan->footing_count[c->foot]++];
    ff_root near_root = ff_plan_root(plan, c->t + 0.62 * step_time);
    footing->speed = sqrt(near_root.forward * near_root.forward + near_root.left * near_root.left);
    set_pitch(plan, footing, &near_root);
    set_times(plan, footing, c->t, step_time);
    bool from_ever = plan->stand_first && index < 2, for_ever = plan->stand_last && index >= n - 2;
    if (from_ever) {
        place_stand(plan, footing, c->foot, plan->begin);
        ff_root leaving = ff_plan_root(plan, footing->toe_off);
        set_pitch(plan, footing, &leaving);
        set_times(plan, footing, c->t, step_time);
        footing->contact = footing->flat = plan->begin - LONG_AGO;
    } else if (for_ever) {
        place_stand(plan, footing, c->foot, plan->end);
    } else {
        place(plan, footing, c->foot, 0.5 * (footing->contact + footing->toe_off), step_time);
    }
    if (for_ever) footing->heel_off = footing->release = footing->toe_off = plan->end + LONG_AGO;
    /* with the heel up the foot turns about the ball, towards where the body has turned meanwhile */
    ff_root leaving = ff_plan_root(plan, footing->release);
    double side = c->foot == 0 ? 1.0 : -1.0;
    double away = leaving.heading + side * plan->style.toe_out - footing->yaw;
    footing->twist = footing->toe_off < plan->end + 1.0 ? 0.4 * away : 0.0;
}

bool ff_plan_finish(ff_plan *plan)
{
    if (!integrate(plan)) return false;
    plan->footing_count[0] = plan->footing_count[1] = 0;
    for (int i = 0; i < plan->contact_count; ++i)
        add_footing(plan, i);
    return true;
}

void ff_plan_free(ff_plan *plan)
{
    free(plan->roots);
    plan->roots = NULL;
}
