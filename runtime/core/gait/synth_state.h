/* synth_state.h - what synthesis remembers of one agent. Plain data, no pointers, no padding: hashed as bytes. */
#ifndef FF_SYNTH_STATE_H
#define FF_SYNTH_STATE_H

#include "runtime/core/gait/blend.h"
#include "runtime/core/pose/pose_offset.h"

enum { FF_GAIT_STAND, FF_GAIT_STEP }; /* ff_gait.mode */

/* A foot as a point of the ground and the air over it. */
typedef struct ff_foothold {
    double a, b, height, yaw; /* of the ball, in the world */
} ff_foothold;

typedef struct ff_gait_foot {
    ff_foothold lock; /* planted: where it stands; in swing: where it will land */
    ff_foothold now;  /* where the ball is */
    ff_foothold path; /* ... and would be if it had nothing to keep clear of */
    /* in swing: offset from the clip's foot when it left the ground (yaw: from the heading) */
    ff_foothold from;
    ff_foothold slope; /* 1/s, of that offset */
    double pitch;      /* rad, toes up + */
    double from_pitch; /* rad, in swing: offset from the clip's pitch when it left the ground */
    ff_foothold left;  /* in swing: where it left the ground ... */
    double left_pitch; /* rad */
    double stood;      /* 0 in the midst of walking to 1 from a stand: ... it sets off the more gradually */
    double elapsed;    /* s, of the swing */
    double progress;   /* 0 to 1 of the swing */
    double phase_left; /* u, to the landing */
    double knee;       /* rad, its bend; 0 while nobody looks after it ... */
    double knee_speed; /* rad/s */
    /* rad, by how much its heel is higher than the gait has it, to be in reach; in swing, as it lifted */
    double raised;
    double tilt;        /* rad, by how much the foot points down, its heel raised to be in reach */
    double above;       /* rad, by how much the heel is raised now, in swing and standing */
    double least_raise; /* rad, in swing: by how much it is raised in any case, */
    double most_raise;  /* ... and may be beyond that, to be in reach */
    double toes;        /* rad, by how much toes are bent up, */
    double toes_more;   /* ... and by how much more than in the motion */
    double give; /* m, that the leg is longer than to its foot in the air, so that the knee takes its time */
    uint32_t planted, unused;
} ff_gait_foot;

/* Drawn once from the agent's variation. */
typedef struct ff_gait_style {
    double cadence; /* factor on the cycle's period */
    double arms;    /* factor on the arm swing */
    double stoop;   /* rad, forward bend of the spine */
    /* of the pack's skeleton. All else in ff_gait is in lengths of that: world lengths over scale */
    double scale;
} ff_gait_style;

struct ff_gait {
    ff_gait_foot foot[2];
    ff_blend blend;
    ff_rates rates;    /* smoothed: what the blend follows */
    double phase;      /* u in [0, 4) */
    double pace;       /* factor on its speed */
    double stand;      /* 0 walking to 1 standing: share of the idle pose, before smoothing */
    double idle_time;  /* s, in the idle example's cycle */
    double hips_drop;  /* m, below the blended height, so that both legs reach */
    double hips_peak;  /* m, of who runs: the most that was needed of it lately */
    double hips_speed; /* m/s, of hips_drop */
    ff_gait_style style;
    ff_pose_offset offset; /* what is left of the last switch */
    double since_switch;   /* s */
    double waited;         /* s, for the moment to switch to what is wanted */
    double seconds[FF_LOCOMOTION_COUNT];
    uint32_t mode, first_foot; /* first_foot: which one steps first when nothing else decides */
    uint32_t wanted;           /* FF_BLENDING, ...; what is played is blend.way */
    uint32_t urgent;           /* 1: to switch to it is pressing */
    uint32_t switches, urgent_switches;
};

#endif
