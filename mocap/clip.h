/* clip.h - the one in-memory form of a motion clip, whatever file it came from.
 *
 * Everything is in metres, seconds and radians, Y up, once a reader has returned. Local rotations are relative
 * to the parent; in the rest pose they are what the file's format makes them (ASF: identity).
 */
#ifndef FF_CLIP_H
#define FF_CLIP_H

#include "mocap/roles.h"
#include "runtime/core/base/maths.h"

typedef struct ff_joint {
    char name[64];
    int parent;     /* -1 = a root; parents come before children */
    ff_vec3 offset; /* m, from the parent in the rest pose */
    int track;      /* index of the joint's position track, -1 = it stays at offset */
    ff_role role;   /* FF_ROLE_NONE when it plays none */
    bool end_site;  /* a tip: no rotation of its own (always identity) */
} ff_joint;

/* A clip has at most this many joints; readers refuse more. */
#define FF_CLIP_MAX_JOINTS 1024

typedef struct ff_clip {
    char *name;   /* file name without folder and ending; owned */
    char *source; /* path as given; owned */
    ff_joint *joints;
    int joint_count;
    int track_count;    /* joints that have a position track */
    double frame_time;  /* s, > 0 */
    int frame_count;    /* >= 1 */
    int first_frame;    /* number the file prints before its first pose (AMC), else 0 */
    int rest_frames;    /* leading frames that are a rest pose, not motion (cgspeed BVH: 1) */
    bool drawn;         /* a cycle that an animator made, not a capture: a knee that snaps is meant to */
    ff_quat *rotations; /* [frame_count][joint_count] local, unit */
    /* [frame_count][track_count] m; REPLACES the offset of the joint that has the track */
    ff_vec3 *positions;
    double unit_m;     /* metres per file unit that were applied */
    int warning_count; /* oddities met and worked around */
    char warning[256]; /* the first of them, "" when none */
} ff_clip;

/* Free what the clip owns and zero it. */
void ff_clip_free(ff_clip *clip);

/* Forward kinematics of one frame: world positions (m) and rotations, [joint_count] each; rotations may be
 * NULL. The caller owns both. */
void ff_clip_pose(const ff_clip *clip, int frame, ff_vec3 *positions, ff_quat *rotations);

/* The rest pose: local rotations identity, roots at their offsets. */
void ff_clip_rest_pose(const ff_clip *clip, ff_vec3 *positions);

/* Keep frames first to last (-1 = to the end) only. */
ff_status ff_clip_keep(ff_clip *clip, int first, int last, ff_error *error);

/* First joint that plays role, or -1. */
int ff_clip_find(const ff_clip *clip, ff_role role);

static inline double ff_clip_seconds(const ff_clip *clip)
{
    return (clip->frame_count - 1) * clip->frame_time;
}

#endif
