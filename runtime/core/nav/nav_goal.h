/* nav_goal.h - where an agent would like to go: towards its goal, and to a stand there. */
#ifndef FF_NAV_GOAL_H
#define FF_NAV_GOAL_H

#include "runtime/core/nav/nav.h"

/* Preferred velocity before any regard for others; zero for one who stands. Watches progress: somebody who gets no
 * nearer for a while settles, when the goal is taken by others who stand there, or else tries a way round; nose to nose with
 * another walker he steps past him at once. */
ff_vec2 ff_nav_preferred(const ff_nav_world *world, uint32_t self, const ff_neighbour *neighbours,
                         uint32_t count, const ff_traits *traits, ff_mind *mind);

/* v_pref turned to the preferred side while somebody is met (navigation study 4, 1), but not into one of the walls near. */
ff_vec2 ff_nav_keep_right(const ff_nav_world *world, uint32_t self, const ff_wall *const *walls,
                          uint32_t wall_count, const ff_traits *traits, ff_vec2 preferred, ff_mind *mind);

/* Where one who stands steps to let those through who want to walk past: across their way, to the side where he
 * already is. Zero when he is in nobody's way. */
ff_vec2 ff_nav_make_way(const ff_nav_world *world, uint32_t self, const ff_neighbour *neighbours,
                        uint32_t count);

/* Two walkers who are in each other's ways hold each other off for as long as they go on. Side by side, the one who wants to go on
 * less falls back and passes behind; and who gets no further for it waits while the other still moves, as he is about to be past. (If
 * both stay they step past each other: ff_nav_preferred.) */
ff_vec2 ff_nav_fall_back(const ff_nav_world *world, uint32_t self, const ff_neighbour *neighbours,
                         uint32_t count, ff_vec2 preferred, const ff_mind *mind);

#endif
