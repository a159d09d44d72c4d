/* contact.h - the stretches in which a foot touches the floor, and when exactly they begin and end. Indices are
 * working frames of ff_foot_signals.
 */
#ifndef FF_CONTACT_H
#define FF_CONTACT_H

#include "preprocess/plants/foot_signals.h"

typedef struct ff_contact {
    int first, last;                   /* inclusive */
    double level[FF_FOOT_POINT_COUNT]; /* m, at which the points rest in this contact */
    int flat_first, flat_last;         /* -1, -1: never flat and still */
    double start_spread, end_spread;   /* s, largest minus smallest estimate */
} ff_contact;

/* Where no part of the foot moves fast: contacts by velocity alone. Writes at most capacity, returns the number. */
int ff_contacts_by_speed(const ff_foot_signals *signals, ff_contact *out, int capacity);

/* Drop contacts above the floor and trim the rest to the frames in which the foot is low, by the heights in
 * signals. tolerance: how far over the plane a foot may stand (m). Returns the new number. */
int ff_contacts_keep_low(const ff_foot_signals *signals, double tolerance, ff_contact *contacts, int count);

/* Move both ends to initial contact and toe-off and find the flat stretch. previous_last and next_first are the
 * neighbouring contacts' ends (-1 and signals->count when there is none); running: 0 walk to 1 run. */
void ff_contact_refine(const ff_foot_signals *signals, int previous_last, int next_first, double running,
                       ff_contact *contact);

/* The levels and the flat stretch alone. */
void ff_contact_find_flat(const ff_foot_signals *signals, double running, ff_contact *contact);

#endif
