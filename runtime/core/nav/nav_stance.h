/* nav_stance.h - nobody steps across the standing foot (FbCrowd eq 6-8).
 *
 * The paper prints eq 6 as the region beyond the standing foot, while its text and figure exclude landing there; the
 * text and the figure are followed. Of eq 7-8, which put a segment outside the disc ("k = 1"), the purpose is kept and
 * not the letter: a half-plane in velocity space, v.n <= c, with c the room between disc and foot over the time of a
 * swing (algorithms C.6). It always admits standing still.
 */
#ifndef FF_NAV_STANCE_H
#define FF_NAV_STANCE_H

#include "runtime/core/nav/nav_solve.h"

/* The foot that alone carries the body; foot 0 left, 1 right, -1 none (both, or neither). */
typedef struct ff_stance {
    int foot;
    ff_vec2 ball;   /* m, in the world */
    double heading; /* rad, from heel to toe */
} ff_stance;

/* Outward normal of the foot's forbidden side: across the foot turned out by 40 degrees, on which one can pivot. */
ff_vec2 ff_stance_normal(const ff_stance *stance);

/* The half-plane's offset c (m/s) for a body at position. */
double ff_stance_room(const ff_stance *stance, ff_vec2 position, double radius);

/* What is remembered between steps: whose line is on (0 none, else foot + 1), and how far it has come in. */
typedef struct ff_stance_memory {
    double ease;
    uint32_t foot, unused;
} ff_stance_memory;

/* Put the line at the end of lines, if there is one; returns the new count. Slower than 0.3 m/s there is none: it would
 * forbid half of all directions, and the study's circle froze. A new foot's line comes in over 0.1 s, from where the last
 * command is. */
uint32_t ff_stance_line(const ff_stance *stance, ff_vec2 position, double radius, ff_vec2 velocity,
                        ff_vec2 command, double step, ff_stance_memory *memory, ff_line *lines,
                        uint32_t count);

#endif
