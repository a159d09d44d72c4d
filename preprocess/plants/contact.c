#include "preprocess/plants/contact.h"

#include "preprocess/base/filter.h"

static const double NEARBY = 0.4;  /* s, about half a stride */
static const double RAISED = 0.04; /* m, surely off the floor */

/* The slowest of the foot's points: near zero while any part of it is on the floor. */
static double slowest(const ff_foot_signals *s, int i)
{
    return ff_min(ff_min(s->speed[FF_FOOT_HEEL][i], s->speed[FF_FOOT_BALL][i]), s->speed[FF_FOOT_TOE][i]);
}

static double lowest(const ff_foot_signals *s, int i)
{
    return ff_min(ff_min(s->height[FF_FOOT_HEEL][i], s->height[FF_FOOT_BALL][i]), s->height[FF_FOOT_TOE][i]);
}

/* A foot is thought slow below a share of the fastest it moves nearby (labels: a quarter of the swing's peak). */
static double speed_limit(const ff_foot_signals *s, int i)
{
    int reach = (int)(NEARBY * s->rate), from = i - reach, to = i + reach;
    double peak = 0.0;
    for (int k = from > 0 ? from : 0; k <= to && k < s->count; ++k)
        peak = ff_max(peak, slowest(s, k));
    return ff_clamp(s->settings->slow_share * peak, s->settings->slow_least, s->settings->slow_most);
}

/* Was the foot really lifted and carried between two contacts? */
static bool is_swing(const ff_foot_signals *s, int last, int first)
{
    ff_vec3 carried = ff_sub3(s->point[FF_FOOT_BALL][first], s->point[FF_FOOT_BALL][last]);
    double peak = 0.0;
    for (int i = last; i <= first; ++i)
        peak = ff_max(peak, slowest(s, i));
    return first - last > s->settings->shortest_swing * s->rate &&
           (ff_length3(carried) > s->settings->carried || peak > 2.0 * s->settings->slow_least);
}

/* Drop contacts that are too short, unless the clip cuts them. */
static int drop_short(const ff_foot_signals *s, ff_contact *contacts, int count)
{
    int kept = 0;
    for (int c = 0; c < count; ++c) {
        bool cut = contacts[c].first == 0 || contacts[c].last == s->count - 1;
        if (contacts[c].last - contacts[c].first + 1 >= s->settings->shortest * s->rate || cut)
            contacts[kept++] = contacts[c];
    }
    return kept;
}

int ff_contacts_by_speed(const ff_foot_signals *s, ff_contact *out, int capacity)
{
    int count = 0;
    bool inside = false;
    for (int i = 0; i < s->count; ++i) {
        bool slow = slowest(s, i) < speed_limit(s, i);
        if (slow && inside) out[count - 1].last = i;
        if (slow && !inside) {
            if (count > 0 && !is_swing(s, out[count - 1].last, i))
                out[count - 1].last = i;
            else if (count < capacity)
                out[count++] = (ff_contact){.first = i, .last = i, .flat_first = -1, .flat_last = -1};
        }
        inside = slow;
    }
    return drop_short(s, out, count);
}

int ff_contacts_keep_low(const ff_foot_signals *s, double tolerance, ff_contact *contacts, int count)
{
    int kept = 0;
    for (int c = 0; c < count; ++c) {
        ff_contact contact = contacts[c];
        double level = lowest(s, contact.first);
        for (int i = contact.first; i <= contact.last; ++i)
            level = ff_min(level, lowest(s, i));
        if (level > tolerance) continue;
        while (lowest(s, contact.first) > ff_max(level, 0.0) + RAISED)
            ++contact.first;
        while (lowest(s, contact.last) > ff_max(level, 0.0) + RAISED)
            --contact.last;
        contacts[kept++] = contact;
    }
    return drop_short(s, contacts, kept);
}
