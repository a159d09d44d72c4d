#include "preprocess/plants/contact.h"

#include "preprocess/base/filter.h"

/* All rules and limits here, and those of the settings, are the contact labels' (labels README, "what a contact is"). */
static const double SWING_REACH = 0.7; /* s: how far into the swing its peak is looked for */
static const double CROSSING = 0.025;  /* s: how long noise may carry a speed to and fro over a limit */
static const double TOES_UP = 0.02;    /* m: ball over heel when a foot rolls off backwards */

/* Up to four estimates of one event. */
typedef struct votes {
    int frame[4], count;
} votes;

static void vote(votes *v, int frame)
{
    v->frame[v->count++] = frame;
}

/* Median: of four, the mean of the middle two. */
static int decide(const votes *v, int otherwise, double rate, double *spread)
{
    *spread = 0.0;
    if (v->count == 0) return otherwise;
    int low = v->frame[0], high = v->frame[0], sum = 0;
    for (int k = 0; k < v->count; ++k) {
        low = v->frame[k] < low ? v->frame[k] : low;
        high = v->frame[k] > high ? v->frame[k] : high;
        sum += v->frame[k];
    }
    *spread = (high - low) / rate;
    if (v->count == 4) return (sum - low - high + 1) / 2;
    return v->count == 3 ? sum - low - high : (v->count == 2 ? (sum + 1) / 2 : low);
}

static int peak_of(const double *values, int from, int to)
{
    int best = from;
    for (int i = from; i <= to; ++i)
        if (values[i] > values[best]) best = i;
    return best;
}

static int clamp_frame(const ff_foot_signals *s, int i)
{
    return i < 0 ? 0 : (i >= s->count ? s->count - 1 : i);
}

/* The height at which each point rests in this contact: median over the frames in which heel and ball are slow, else
 * over all of them. Sampled at up to LEVEL_SAMPLES frames. */
static void find_levels(const ff_foot_signals *s, ff_contact *c)
{
    enum { LEVEL_SAMPLES = 256 };
    double sample[LEVEL_SAMPLES];
    int step = (c->last - c->first) / LEVEL_SAMPLES + 1;
    for (int p = 0; p < FF_FOOT_POINT_COUNT; ++p) {
        for (int pass = 0, m = 0; pass < 2 && m == 0; ++pass) {
            for (int i = c->first; i <= c->last; i += step)
                if (pass == 1 || (s->speed[FF_FOOT_HEEL][i] < s->settings->still &&
                                  s->speed[FF_FOOT_BALL][i] < s->settings->still))
                    sample[m++] = s->height[p][i];
            if (m > 0) c->level[p] = ff_filter_quantile(sample, m, 0.5);
        }
    }
}

/* Vertical acceleration of a point. */
static double rise(const ff_foot_signals *s, int p, int i)
{
    int b = clamp_frame(s, i - 2), a = clamp_frame(s, i + 2);
    return s->point[p][a].y - 2.0 * s->point[p][i].y + s->point[p][b].y;
}

/* Toes over heel: falls while the foot turns down onto its sole. */
static double pitch(const ff_foot_signals *s, int i)
{
    return s->height[FF_FOOT_BALL][i] - s->height[FF_FOOT_HEEL][i];
}

static double pitch_rate(const ff_foot_signals *s, int i)
{
    return pitch(s, clamp_frame(s, i + 1)) - pitch(s, clamp_frame(s, i - 1));
}

/* First frame after the swing's peak at which the point is slow and low; noise makes the first of several crossings
 * early, so the middle between the first and the last one is taken. -1: never. */
static int comes_to_rest(const ff_foot_signals *s, const ff_contact *c, int p, int peak, double limit,
                         double low)
{
    int reach = (int)(CROSSING * s->rate);
    for (int i = peak; i <= c->last; ++i) {
        if (s->speed[p][i] >= limit || s->height[p][i] >= c->level[p] + low) continue;
        int end = i;
        for (int k = i + 1; k <= i + reach && k <= c->last; ++k)
            if (s->speed[p][k] >= limit) end = k + 1;
        return (i + end + 1) / 2;
    }
    return -1;
}

/* First frame after the swing's peak from which on the point is at its level for a while. -1: never. */
static int comes_down(const ff_foot_signals *s, const ff_contact *c, int p, int peak)
{
    int stay = (int)(CROSSING * s->rate), since = 0;
    for (int i = peak; i <= c->last; ++i) {
        since = s->height[p][i] < c->level[p] + s->settings->at_level ? since + 1 : 0;
        if (since > stay) return i - stay;
    }
    return -1;
}

/* The blow of landing: where the point is pushed upwards most. It comes after the point has slowed down, so little
 * time is searched before. */
static int strongest_rise(const ff_foot_signals *s, int p, int around, int reach)
{
    int best = around;
    for (int i = clamp_frame(s, around); i <= clamp_frame(s, around + reach); ++i)
        if (rise(s, p, i) > rise(s, p, best)) best = i;
    return best;
}

/* Start of the turn down onto the sole: where the pitch rate first reaches a share of its strongest. -1: no turn. */
static int turns_down(const ff_foot_signals *s, int around, int before, int after)
{
    int low = clamp_frame(s, around - before), best = around;
    for (int i = low; i <= clamp_frame(s, around + after); ++i)
        if (pitch_rate(s, i) < pitch_rate(s, best)) best = i;
    double strongest = pitch_rate(s, best);
    if (strongest * s->rate > -0.2) return -1; /* m/s of the ball about the heel */
    int i = best;
    while (i > low && pitch_rate(s, i - 1) < 0.8 * strongest)
        --i;
    return i;
}

static void find_start(const ff_foot_signals *s, int previous_last, double running, ff_contact *c)
{
    if (c->first == 0) return;
    int from = (int)ff_max(previous_last + 1, c->first - SWING_REACH * s->rate);
    from = clamp_frame(s, from);
    int peak = peak_of(s->speed[FF_FOOT_HEEL], from, c->first);
    double limit = ff_clamp(s->settings->slow_share * s->speed[FF_FOOT_HEEL][peak], s->settings->slow_least,
                            ff_lerp(0.9, s->settings->slow_most, running));
    votes v = {.count = 0};
    int heel = comes_to_rest(s, c, FF_FOOT_HEEL, peak, limit, s->settings->heel_low);
    int ball_peak = peak_of(s->speed[FF_FOOT_BALL], from, c->first);
    double ball_limit = ff_clamp(s->settings->slow_share * s->speed[FF_FOOT_BALL][ball_peak],
                                 s->settings->slow_least, ff_lerp(0.9, s->settings->slow_most, running));
    int ball = comes_to_rest(s, c, FF_FOOT_BALL, ball_peak, ball_limit, s->settings->ball_low);
    int late = (int)(0.03 * s->rate), reach = (int)(0.05 * s->rate + 0.5);
    if (ball >= 0 && (heel < 0 || ball + late < heel)) {
        vote(&v, ball);
        vote(&v, strongest_rise(s, FF_FOOT_BALL, ball, reach));
        int down = comes_down(s, c, FF_FOOT_BALL, ball_peak);
        if (down >= 0) vote(&v, down);
    } else if (heel >= 0) {
        vote(&v, heel);
        vote(&v, strongest_rise(s, FF_FOOT_HEEL, heel, reach));
        int turn = turns_down(s, heel, reach, 2 * reach), down = comes_down(s, c, FF_FOOT_HEEL, peak);
        if (turn >= 0) vote(&v, turn);
        if (down >= 0) vote(&v, down);
    }
    int first = decide(&v, c->first, s->rate, &c->start_spread);
    c->first = first < c->last ? first : c->last;
}

/* Last frame before the swing's peak at which the point was slow, the middle of several crossings likewise. */
static int leaves_rest(const ff_foot_signals *s, const ff_contact *c, int p, int peak, double limit)
{
    int i = peak, reach = (int)(CROSSING * s->rate);
    while (i > c->first && s->speed[p][i] >= limit)
        --i;
    int begin = i;
    for (int k = i - 1; k >= i - reach && k > c->first; --k)
        if (s->speed[p][k] >= limit) begin = k - 1;
    return (i + begin) / 2;
}

/* Last frame before another one at which the point was at its level. */
static int lifts(const ff_foot_signals *s, const ff_contact *c, int p, int before)
{
    int i = before;
    while (i > c->first && s->height[p][i] > c->level[p] + s->settings->lifted)
        --i;
    return i;
}

static double push(const ff_foot_signals *s, int i)
{
    const ff_vec3 *toe = s->point[FF_FOOT_TOE];
    ff_vec3 v1 = ff_filter_velocity(toe, s->count, clamp_frame(s, i + 1), s->rate);
    ff_vec3 v0 = ff_filter_velocity(toe, s->count, clamp_frame(s, i - 1), s->rate);
    return ff_length2(ff_plane(ff_sub3(v1, v0)));
}

/* Half height of the rise of the toe's horizontal acceleration. */
static int half_push(const ff_foot_signals *s, int around, int before, int after)
{
    int best = around, low = clamp_frame(s, around - before);
    for (int i = low; i <= clamp_frame(s, around + after); ++i)
        if (push(s, i) > push(s, best)) best = i;
    int i = best;
    while (i > low && push(s, i) > 0.5 * push(s, best))
        --i;
    return i;
}

/* The clip may end between toe-off and the peak of the swing: the swing before the contact then tells how fast the
 * foot will become. */
static double swing_peak(const ff_foot_signals *s, const ff_contact *c, int peak)
{
    const double *speed = s->speed[FF_FOOT_BALL];
    if (peak < s->count - 1) return speed[peak];
    int before = clamp_frame(s, (int)(c->first - SWING_REACH * s->rate));
    return ff_max(speed[peak], speed[peak_of(speed, before, c->first)]);
}

static void find_end(const ff_foot_signals *s, int next_first, double running, ff_contact *c)
{
    int to = clamp_frame(s, (int)ff_min(next_first - 1, c->last + SWING_REACH * s->rate));
    int peak = peak_of(s->speed[FF_FOOT_BALL], c->last, to > c->last ? to : c->last);
    double limit = ff_clamp(s->settings->slow_share * swing_peak(s, c, peak), s->settings->slow_least,
                            ff_lerp(0.9, 1.15, running));
    int toe = leaves_rest(s, c, FF_FOOT_TOE, peak, limit);
    /* At the clip's end: still standing, or only just coming down. */
    if (c->last == s->count - 1 && (toe == peak || toe == c->first)) return;
    votes v = {.count = 0};
    vote(&v, toe);
    vote(&v, leaves_rest(s, c, FF_FOOT_BALL, peak, 1.15 * limit));
    int heel = leaves_rest(s, c, FF_FOOT_HEEL, peak, limit);
    if (pitch(s, heel) > TOES_UP) {
        /* Who walks backwards rolls off over the heel: the middle of the roll. */
        v.count = 0;
        vote(&v, (lifts(s, c, FF_FOOT_BALL, heel) + heel) / 2);
    } else if (c->last < s->count - 1)
        vote(&v, half_push(s, toe, (int)(0.06 * s->rate), (int)(0.12 * s->rate)));
    int last = decide(&v, c->last, s->rate, &c->end_spread);
    c->last = last > c->first ? last : c->first;
}

void ff_contact_find_flat(const ff_foot_signals *s, double running, ff_contact *c)
{
    const ff_plant_settings *set = s->settings;
    double ball = set->flat_ball_speed * (1.0 + running), heel = set->flat_heel_speed * (1.0 + running);
    int begin = -1;
    find_levels(s, c);
    c->flat_first = c->flat_last = -1;
    for (int i = c->first; i <= c->last + 1; ++i) {
        bool flat = i <= c->last && s->speed[FF_FOOT_BALL][i] < ball && s->speed[FF_FOOT_HEEL][i] < heel &&
                    s->height[FF_FOOT_HEEL][i] < c->level[FF_FOOT_HEEL] + set->flat_heel_up &&
                    s->height[FF_FOOT_BALL][i] < c->level[FF_FOOT_BALL] + set->flat_ball_up;
        if (flat && begin < 0) begin = i;
        if (!flat && begin >= 0) {
            if (i - begin > c->flat_last - c->flat_first + 1 || c->flat_first < 0) {
                c->flat_first = begin;
                c->flat_last = i - 1;
            }
            begin = -1;
        }
    }
}

void ff_contact_refine(const ff_foot_signals *s, int previous_last, int next_first, double running,
                       ff_contact *c)
{
    find_levels(s, c);
    find_start(s, previous_last, running, c);
    find_end(s, next_first, running, c);
    ff_contact_find_flat(s, running, c);
}
