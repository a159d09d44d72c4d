#include "preprocess/clean/clean_problem.h"

#include <string.h>

/* How far off things may be: cleanup study, section 3.4. */
#define KNEE 1.0       /* degrees */
#define KNOT_RATE 30.0 /* Hz, of the knots the weights are meant for */

#define PER_DEG(degrees) (1.0 / ((degrees)*FF_DEG))

const double ff_clean_root_close[FF_CLEAN_ROOT] = {1.0 / 0.02,   1.0 / 0.02,   1.0 / 0.02,
                                                   PER_DEG(2.0), PER_DEG(2.0), PER_DEG(2.0)};
const double ff_clean_root_smooth[FF_CLEAN_ROOT] = {1.0 / 4.0,  1.0 / 4.0,  1.0 / 4.0,
                                                    1.0 / 20.0, 1.0 / 20.0, 1.0 / 20.0};
const double ff_clean_leg_close[FF_CLEAN_LEG] = {PER_DEG(4.0), PER_DEG(4.0), PER_DEG(4.0), PER_DEG(4.0),
                                                 PER_DEG(6.0), PER_DEG(6.0), PER_DEG(6.0), PER_DEG(10.0)};
const double ff_clean_leg_smooth[FF_CLEAN_LEG] = {1.0 / 20.0, 1.0 / 20.0, 1.0 / 20.0, 1.0 / 20.0,
                                                  1.0 / 20.0, 1.0 / 20.0, 1.0 / 20.0, 1.0 / 40.0};

void ff_clean_plant_tie(const ff_clean_problem *problem, double out[FF_CLEAN_PLANT])
{
    out[0] = out[1] = 1.0 / problem->settings->tie;
    out[2] = PER_DEG(6.0);
}

double ff_clean_knot_weight(const ff_clean_problem *problem)
{
    return sqrt(KNOT_RATE * problem->knot_time);
}

/* Scale one row of slopes into the caller's matrix. */
static void put_row(const double *from, int width, double scale, double *out)
{
    for (int i = 0; i < width; ++i)
        out[i] = scale * from[i];
}

void ff_clean_pin_term(const ff_clean_problem *problem, int knot, int side, const double *root,
                       const double *leg, const double *plant, double *residuals, double **slopes)
{
    const ff_clean_knot *at = &problem->knots[knot];
    const ff_clean_plant *planted = &problem->plants[at->plant[side]];
    double weight = ff_clean_knot_weight(problem) / problem->settings->pin;
    double strength[2] = {weight * at->heel[side], weight * at->ball[side]};
    ff_vec3 places[FF_FOOT_PLACES];
    ff_clean_slopes own;
    ff_clean_foot(problem->rig, &at->pose, side, root, leg, places, slopes ? &own : NULL);
    double reach = ff_foot_reach(problem->rig, planted->ball_height - planted->heel_height), s, c;
    ff_sincos(plant[2], &s, &c);
    ff_vec3 ball = ff_v3(plant[0], planted->ball_height, plant[1]);
    ff_vec3 heel = ff_v3(plant[0] - reach * s, planted->heel_height, plant[1] - reach * c);
    ff_vec3 off[2] = {ff_sub3(places[FF_FOOT_AT_HEEL], heel), ff_sub3(places[FF_FOOT_AT_BALL], ball)};
    for (int p = 0; p < 2; ++p) {
        double w = strength[p];
        residuals[3 * p] = w * off[p].x;
        residuals[3 * p + 1] = w * off[p].y;
        residuals[3 * p + 2] = w * off[p].z;
        for (int i = 0; slopes && i < 3; ++i) {
            int row = 3 * p + i;
            if (slopes[0]) put_row(own.root[p][i], FF_CLEAN_ROOT, w, slopes[0] + row * FF_CLEAN_ROOT);
            if (slopes[1]) put_row(own.leg[p][i], FF_CLEAN_LEG, w, slopes[1] + row * FF_CLEAN_LEG);
        }
        if (!slopes || !slopes[2]) continue;
        double *on_plant = slopes[2] + (size_t)(3 * p) * FF_CLEAN_PLANT;
        memset(on_plant, 0, 3 * FF_CLEAN_PLANT * sizeof *on_plant);
        on_plant[0] = -w;
        on_plant[2 * FF_CLEAN_PLANT + 1] = -w;
        if (p != FF_FOOT_AT_HEEL) continue;
        on_plant[2] = w * reach * c;
        on_plant[2 * FF_CLEAN_PLANT + 2] = -w * reach * s;
    }
}

void ff_clean_ground_term(const ff_clean_problem *problem, int knot, int side, const double *root,
                          const double *leg, double *residuals, double **slopes)
{
    const ff_clean_knot *at = &problem->knots[knot];
    ff_vec3 places[FF_FOOT_PLACES];
    ff_clean_slopes own;
    ff_clean_foot(problem->rig, &at->pose, side, root, leg, places, slopes ? &own : NULL);
    double weight = ff_clean_knot_weight(problem) / problem->settings->ground;
    for (int p = 0; p < FF_FOOT_PLACES; ++p) {
        double lowest = at->ground[side] -
                        (p == FF_FOOT_AT_TOE ? problem->settings->under_toe : problem->settings->under);
        double under = lowest - places[p].y, w = under > 0.0 ? -weight : 0.0;
        residuals[p] = under > 0.0 ? weight * under : 0.0;
        if (slopes && slopes[0]) put_row(own.root[p][1], FF_CLEAN_ROOT, w, slopes[0] + p * FF_CLEAN_ROOT);
        if (slopes && slopes[1]) put_row(own.leg[p][1], FF_CLEAN_LEG, w, slopes[1] + p * FF_CLEAN_LEG);
    }
}

void ff_clean_knee_term(const ff_clean_problem *problem, int knot, int side, const double *leg,
                        double *residuals, double **slopes)
{
    double weight = ff_clean_knot_weight(problem) * PER_DEG(KNEE);
    double lacking =
        problem->settings->knee * FF_DEG - problem->knots[knot].pose.flexion[side] - leg[FF_CLEAN_KNEE];
    residuals[0] = lacking > 0.0 ? weight * lacking : 0.0;
    if (!slopes || !slopes[0]) return;
    memset(slopes[0], 0, FF_CLEAN_LEG * sizeof *slopes[0]);
    if (lacking > 0.0) slopes[0][FF_CLEAN_KNEE] = -weight;
}
