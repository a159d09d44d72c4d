/* pack_format.h - the motion pack, byte by byte. Little-endian. One file: ff_pack_header, the section table, then
 * the sections, each starting on a 64-byte boundary and used in place. Records are plain structs without
 * padding; a `name` is a byte offset into the STRS section, whose strings end with 0 and whose first byte is 0.
 *
 * A change of any record's meaning raises FF_PACK_VERSION. runtime/README.md describes the same for people.
 */
#ifndef FF_PACK_FORMAT_H
#define FF_PACK_FORMAT_H

#include <stdint.h>

#define FF_PACK_MAGIC 0x4b434150464f4f46u /* "FOOFPACK" read as a little-endian u64 */
#define FF_PACK_VERSION 3u
#define FF_PACK_ALIGN 64u
#define FF_PACK_MAX_JOINTS 64u
#define FF_PACK_RATE                                                                                         \
    60.0 /* Hz, of the frames that feet and tracks are given for (examples: a whole number per cycle) */

#define FF_TAG(a, b, c, d) ((uint32_t)(a) | (uint32_t)(b) << 8 | (uint32_t)(c) << 16 | (uint32_t)(d) << 24)
enum {
    FF_SECTION_STRINGS = FF_TAG('S', 'T', 'R', 'S'),   /* char */
    FF_SECTION_META = FF_TAG('M', 'E', 'T', 'A'),      /* char: provenance and settings as JSON text */
    FF_SECTION_JOINTS = FF_TAG('J', 'N', 'T', 'S'),    /* ff_pack_joint */
    FF_SECTION_POINTS = FF_TAG('P', 'N', 'T', 'S'),    /* ff_pack_point */
    FF_SECTION_STREAMS = FF_TAG('S', 'T', 'R', 'M'),   /* ff_pack_stream */
    FF_SECTION_SLOTS = FF_TAG('S', 'L', 'O', 'T'),     /* ff_pack_slots: one per stream */
    FF_SECTION_LANES = FF_TAG('L', 'A', 'N', 'E'),     /* ff_pack_lanes */
    FF_SECTION_KEYS = FF_TAG('K', 'E', 'Y', 'S'),      /* bytes */
    FF_SECTION_ROOTS = FF_TAG('R', 'O', 'O', 'T'),     /* float[3]: a (m), b (m), heading (rad, unwrapped) */
    FF_SECTION_CLIPS = FF_TAG('C', 'L', 'I', 'P'),     /* ff_pack_clip */
    FF_SECTION_PLANTS = FF_TAG('P', 'L', 'N', 'T'),    /* ff_pack_plant */
    FF_SECTION_ACTIONS = FF_TAG('A', 'C', 'T', 'N'),   /* ff_pack_action */
    FF_SECTION_COLLIDERS = FF_TAG('C', 'O', 'L', 'L'), /* ff_pack_collider */
    FF_SECTION_COLLIDER_RADII =
        FF_TAG('C', 'R', 'A', 'D'),                    /* float: m, of the cylinder about each collider */
    FF_SECTION_EXAMPLES = FF_TAG('E', 'X', 'M', 'P'),  /* ff_pack_example */
    FF_SECTION_FEET = FF_TAG('F', 'E', 'E', 'T'),      /* ff_pack_foot: per example frame, left then right */
    FF_SECTION_SIMPLICES = FF_TAG('S', 'M', 'P', 'X'), /* ff_pack_simplex */
    FF_SECTION_HULL = FF_TAG('H', 'U', 'L', 'L'),      /* ff_pack_point2, counter-clockwise in (f, l) */
    FF_SECTION_TRACKS =
        FF_TAG('T', 'R', 'C', 'K'), /* ff_pack_track: per clip frame, left then right; optional */
    FF_SECTION_LOOPS = FF_TAG('L', 'O', 'O', 'P'),           /* ff_pack_loop: one per example, or none */
    FF_SECTION_CORRESPONDENCES = FF_TAG('C', 'O', 'R', 'R'), /* ff_pack_correspondence */
    FF_SECTION_PAIRS = FF_TAG('P', 'A', 'I', 'R'),           /* ff_pack_pair */
    FF_SECTION_GAIT = FF_TAG('G', 'A', 'I', 'T'),            /* ff_pack_gait: one, or none */
    FF_SECTION_GAIT_PATH = FF_TAG('G', 'P', 'T', 'H'),       /* ff_pack_gait_path: FF_GAIT_SAMPLES, or none */
    FF_SECTION_SHARP = FF_TAG('S', 'H', 'R', 'P'),           /* ff_pack_sharp */
    FF_SECTION_EVENTS = FF_TAG('E', 'V', 'N', 'T'),          /* ff_pack_event: of actions, in order of time */
    FF_SECTION_SKINS = FF_TAG('S', 'K', 'I', 'N'), /* ff_pack_skin: levels of detail, finest first, or none */
    FF_SECTION_VERTICES = FF_TAG('V', 'E', 'R', 'T'),   /* ff_pack_vertex */
    FF_SECTION_TRIANGLES = FF_TAG('I', 'N', 'D', 'X'),  /* ff_pack_triangle */
    FF_SECTION_SUCCESSORS = FF_TAG('N', 'E', 'X', 'T'), /* ff_pack_successor: of actions, nearest first */
    FF_SECTION_REACH = FF_TAG('R', 'E', 'A', 'C'), /* ff_pack_reach: of actions that lead to much the same */
};
#define FF_PACK_SECTION_COUNT 31

typedef struct ff_pack_header {
    uint64_t magic;
    uint32_t version;
    uint32_t section_count;
    uint64_t file_size; /* bytes, whole file */
    uint64_t checksum;  /* XXH64, seed 0, of every byte from the section table to the end of the file */
} ff_pack_header;       /* 32 bytes; the section table follows at once */

typedef struct ff_pack_section {
    uint32_t tag;
    uint32_t stride; /* bytes per element */
    uint64_t count;  /* elements */
    uint64_t offset; /* bytes from the start of the file, multiple of FF_PACK_ALIGN */
    uint64_t size;   /* bytes = stride * count */
} ff_pack_section;

/* Joint j plays ff_role j (mocap/roles.h). In the rest pose every global rotation is the identity, the
 * character faces +Z, arms out to the sides, legs straight down, feet flat. */
typedef struct ff_pack_joint {
    int32_t parent; /* -1 for joint 0, else smaller than the joint's own index */
    uint32_t name;
    float offset[3]; /* m from the parent; joint 0: (0, hips height in the rest pose, 0) */
    float radius;    /* m, of the bone that starts here, for drawing and colliders */
} ff_pack_joint;

/* The surface of a character in the rest pose, at one level of detail: a stretch of VERT and of INDX. Drawing may use it;
 * a pack without any is drawn as a body of capsules about its bones. */
typedef struct ff_pack_skin {
    uint32_t first_vertex, vertex_count;
    uint32_t first_triangle, triangle_count;
} ff_pack_skin;
typedef struct ff_pack_vertex {
    float position[3], normal[3]; /* m, rest pose; unit */
    float uv[2];
    uint8_t joints[4];  /* unused ones are 0 */
    uint8_t weights[4]; /* / 255, of the joints; they add up to 255 */
} ff_pack_vertex;
typedef struct ff_pack_triangle {
    uint32_t corner[3]; /* vertices of its level, from first_vertex on; counter-clockwise from outside */
} ff_pack_triangle;

/* A point fixed on a joint: tips and heels. kind: 0 head top, 1 left hand, 2 right hand, 3 left toe,
 * 4 right toe, 5 left heel, 6 right heel. The sole is at y = 0 in the rest pose. */
enum {
    FF_POINT_HEAD_TOP,
    FF_POINT_HAND_L,
    FF_POINT_HAND_R,
    FF_POINT_TOE_L,
    FF_POINT_TOE_R,
    FF_POINT_HEEL_L,
    FF_POINT_HEEL_R,
    FF_POINT_COUNT
};
typedef struct ff_pack_point {
    int32_t joint;
    uint32_t kind;
    float offset[3]; /* m, in the joint's frame */
} ff_pack_point;

/* A stream is a motion as uniform cubic B-splines: values between keys k and k + 1 come from the four keys from k on,
 * with weights that are sums of thirds and sixths, so any moment needs four neighbouring keys and nothing else.
 *
 * What moves is a lane: keys of 8 bits (narrow) or 16 (wide) at one of FF_STREAM_LEVELS rates, or none (a lane that
 * stands still at a value). The pose is made of slots [component][joint]: joint j's local rotation is, up to length,
 * reference * (x, y, z, w), and "joint" FF_STREAM_HIPS holds the position of the hips in the root's frame: forward,
 * left, height. A slot without a lane is 0 or 1 (w, unless flagged FF_STREAM_FOUR_PARTS, is always 1).
 *
 * A frame is a moment k / rate of a stream for which FEET and TRCK have records; frames are numbered through all streams.
 * A cyclic stream of n frames spans n intervals, any other one n - 1 or a little more. */
enum { FF_STREAM_CYCLIC = 1, FF_STREAM_FOUR_PARTS = 2 };
enum { FF_STREAM_LEVELS = 4, FF_STREAM_SLOTS = 24, FF_STREAM_HIPS = 21, FF_STREAM_BLOCKS = 31 };

/* Keys 0 to intervals + 2 of all lanes of one rate; intervals span the stream. A key holds the wide lanes as int16, then
 * the narrow ones as int8; keys follow each other without gaps, at odd addresses too. A cyclic stream's last three keys
 * are its first three. FF_STREAM_SLACK more bytes lie behind a stream's last key, so that whole vectors can be read. */
#define FF_STREAM_SLACK 16u
typedef struct ff_pack_level {
    uint32_t first_byte; /* into KEYS */
    uint32_t intervals;
    uint16_t wide, narrow; /* lanes */
} ff_pack_level;

typedef struct ff_pack_stream {
    uint32_t first_frame, frame_count;
    float rate; /* frames per second */
    uint32_t flags;
    float seconds; /* from the first to the last moment, or round the cycle */
    /* Into LANE: per level the wide, then the narrow lanes, then the still ones. Each run of lanes begins a block; at
     * most FF_STREAM_BLOCKS of them. */
    uint32_t first_lanes;
    uint32_t still;          /* lanes without keys */
    uint32_t first_root;     /* into ROOT */
    uint32_t root_intervals; /* 0: no keys, the root stays at zero; else keys 0 to root_intervals + 2 */
    ff_pack_level level[FF_STREAM_LEVELS];
} ff_pack_stream;

/* Per stream: the reference rotations, joint j's at [j], and what each slot shows: FF_LANE_ZERO, FF_LANE_ONE, or
 * FF_LANE_FIRST + 8 * block + place in the block. */
enum { FF_LANE_ZERO, FF_LANE_ONE, FF_LANE_FIRST = 8 };
typedef struct ff_pack_slots {
    float x[FF_STREAM_SLOTS], y[FF_STREAM_SLOTS], z[FF_STREAM_SLOTS], w[FF_STREAM_SLOTS];
    uint8_t lane[4][FF_STREAM_SLOTS];
} ff_pack_slots;

/* A block of up to eight lanes (0 where unused). The value is base + scale * S; S = sum of W_i k_i over the four keys, W_i
 * the weights in 32768ths, a narrow k_i times 256. */
typedef struct ff_pack_lanes {
    float base[8], scale[8];
} ff_pack_lanes;

/* A derived clip was made from a captured one for an action that no clip shows; source, licence and citation are that
 * clip's. */
enum { FF_CLIP_DERIVED = 1 };
typedef struct ff_pack_clip {
    uint32_t name, source, licence, citation, tags;
    uint32_t stream;
    uint32_t first_plant, plant_count;
    uint32_t first_action, action_count; /* unmirrored ones */
    uint64_t source_hash;                /* XXH64 of the file's bytes */
    float source_rate;                   /* Hz */
    float floor_base, floor_slope[2];    /* m; m per m along a and b */
    float time_offset;                   /* s, of stream frame 0 after the file's first pose */
    uint32_t flags;
} ff_pack_clip;

/* One foot plant; times in s from the file's first pose; flat_* = -1 when never flat. */
typedef struct ff_pack_plant {
    uint32_t clip, foot; /* 0 left, 1 right */
    float start, end, flat_start, flat_end;
    float ball[2];    /* a, b: m, in the clip's world */
    float yaw;        /* rad */
    float slide;      /* m */
    float confidence; /* 0..1 */
    float level;      /* m over the clip's floor: 0 on the floor itself, else a step, a box, a stone */
    uint32_t origin;  /* FF_PLANT_*: who says so */
} ff_pack_plant;
enum {
    FF_PLANT_FOUND,
    FF_PLANT_WRITTEN,
    FF_PLANT_ORIGIN_COUNT
}; /* by the detector; by a person (override file) */

/* Locomotion modes of Table 1 (Beacco et al. 2013). */
enum {
    FF_MODE_IDLE,
    FF_MODE_WALK_SHORT,
    FF_MODE_WALK_LONG,
    FF_MODE_RUN,
    FF_MODE_JUMP,
    FF_MODE_CLIMB,
    FF_MODE_TURN,
    FF_MODE_CROUCH,
    FF_MODE_START,
    FF_MODE_STOP,
    FF_MODE_COUNT
};

enum {
    FF_ACTION_MIRRORED = 1,
    FF_ACTION_ALPHA_UNDEFINED = 2,
    FF_ACTION_DERIVED = 4,        /* made from a captured step or pose, not captured as such */
    FF_ACTION_WHOLE = 8,          /* several steps, or a jump or a duck, that are played complete */
    FF_ACTION_FROM_STANDING = 16, /* both feet stand at t_0 */
    FF_ACTION_TO_STANDING =
        32 /* both feet stand at t_end, the support foot where it stood at t_0, unless WHOLE */
};

/* A single step (or a whole action: a turn on the spot, a jump, a duck) with the annotation of Table 1. Frame S0 = the support foot's ball on
 * the ground at t_0 as origin, root heading at t_0 as forward axis; components are (forward, left). Mirrored
 * actions play the same stream frames with sides swapped; their record is already mirrored. */
typedef struct ff_pack_action {
    uint32_t clip, mode;
    uint32_t support, swing; /* foot 0 left, 1 right */
    uint32_t flags;
    float t_0, t_end;            /* s, in the clip (from the file's first pose) */
    float duration;              /* t, s */
    float root_displacement[2];  /* v_r: whole root displacement over the step, m, in the root frame at t_0 */
    float speed;                 /* m/s = |root_displacement| / t */
    float direction;             /* rad, of root_displacement */
    float swing_displacement[2]; /* f: swing foot from its old plant to its new one, m */
    float alpha;                 /* rad, swing-relative step angle */
    float theta;                 /* rad, heading change, + = left */
    float step_length, step_width;    /* m, ball to ball along and across the heading at t_0 */
    float root_start[3], root_end[3]; /* a, b, heading in S0 */
    float land[3];                    /* a, b, yaw of the new plant's ball in S0 */
    float support_yaw;                /* rad, of the support foot in S0 */
    float energy;                     /* J/kg over the step: integral of e_s + e_w v^2 */
    float flight[2];                  /* s in the clip, -1, -1 when a foot was always down */
    float coarse_radius;              /* m, cylinder round the root that holds all five colliders */
    float height;                     /* m, of the support plant over the clip's floor (its level) */
    float rise;                       /* m, of the landing over the support plant: steps up and down */
    uint32_t first_collider, collider_samples; /* COLL: samples * FF_COLLIDER_COUNT elements */
    uint32_t support_plant, swing_plant;       /* into PLNT */
    uint32_t first_event, event_count;         /* EVNT */
    uint32_t first_successor, successor_count; /* NEXT */
    uint32_t reach; /* into REAC; FF_REACH_NONE: not among the actions that planners take by default */
} ff_pack_action;

/* What a foot does inside an action. The plant is in PLNT; a mirrored action's foot is the other one's. */
enum { FF_EVENT_CONTACT, FF_EVENT_FLAT, FF_EVENT_HEEL_OFF, FF_EVENT_TOE_OFF, FF_EVENT_KIND_COUNT };
typedef struct ff_pack_event {
    float time; /* s, in the clip, as t_0 and t_end: from the file's first pose */
    uint32_t foot, kind, plant;
} ff_pack_event;

/* An action that may follow another one: it stands on the foot that has just landed (or, where both actions stand at
 * the joint, on either), its speed and turn are near (algorithms A.13) and so is its pose. A support foot that differs
 * from the landed one, which only standing allows, is anchored where it stands. */
typedef struct ff_pack_successor {
    uint32_t action;
    /* m, root mean square of the joints over 5 frames round the joint, the support foot aligned */
    float distance;
    float cost; /* J/kg that a planner is charged for the joint (footstep study, section 4.5) */
} ff_pack_successor;

/* What it costs, J/kg, to come to stand with the root within FF_REACH_RADIUS of a place in empty space, from where an action
 * has ended with the left foot landed: seen from the root, along its heading (for the right one: mirrored). Place [i][k] is
 * FF_REACH_CELL * (i - FF_REACH_CELLS / 2) ahead, the same with k to the left. By the actions that have a table alone; at
 * most what any of a table's actions needs (footstep study, section 4.2). */
#define FF_REACH_CELL 0.1f    /* m */
#define FF_REACH_RADIUS 0.35f /* m */
#define FF_REACH_UNIT 1e-3f   /* J/kg of one */
enum { FF_REACH_CELLS = 81, FF_REACH_KINDS_MAX = 64, FF_REACH_NEVER = 0xffff };
#define FF_REACH_NONE 0xffffffffu
typedef struct ff_pack_reach {
    uint16_t cost[FF_REACH_CELLS][FF_REACH_CELLS + 1]; /* the last column is not used */
} ff_pack_reach;

enum {
    FF_COLLIDER_HEAD,
    FF_COLLIDER_HAND_L,
    FF_COLLIDER_HAND_R,
    FF_COLLIDER_FOOT_L,
    FF_COLLIDER_FOOT_R,
    FF_COLLIDER_ROOT,
    FF_COLLIDER_COUNT
};
typedef struct ff_pack_collider {
    float a, b, y; /* m, in S0; y over the support plant's level */
} ff_pack_collider;

/* Gait classes are never blended with each other. */
enum { FF_GAIT_WALK, FF_GAIT_RUN, FF_GAIT_COUNT };
enum {
    FF_EXAMPLE_IDLE = 1,
    FF_EXAMPLE_MIRRORED = 2,
    FF_EXAMPLE_DERIVED = 4,
    FF_EXAMPLE_LOOSE =
        8 /* for want of a good cycle: one step and its mirror image, or one that closes badly */
};

/* One seamless gait cycle at constant root rates. Key phases are fractions of the cycle in [0, 1): left contact
 * (always 0), right toe-off, right contact, left toe-off: increasing for walks; idle has 0, .1, .5, .6. */
typedef struct ff_pack_example {
    uint32_t name, clip, stream, gait, flags;
    float period;                       /* s */
    float v_forward, v_left, turn_rate; /* m/s, m/s, rad/s */
    float key[4];
    float lock[2][2]; /* per foot: phases between which the ball stands still (start may exceed end: wraps);
                           end < 0 = always (idle) */
    float seam;       /* m, mean joint distance of the last from the first pose before closing */
} ff_pack_example;

/* Where a foot is in the constant-rate root frame, per example frame; index = 2 * (frame - first EXMP frame) + foot.
 * Examples' streams come first in STRM in EXMP order, so FEET has 2 * (number of example frames) elements. */
typedef struct ff_pack_foot {
    float ball[3]; /* forward, left, height: m */
    float yaw;     /* rad, heel to ball, relative to the root's heading */
    float pitch;   /* rad, toes up + */
} ff_pack_foot;

/* Simplex of examples in (v_forward, v_left, turn_rate), for barycentric blending within one gait class;
 * vertex count 1 to 4, unused are -1. What blending needs of the walks' simplices: tetrahedra wherever possible (flat
 * simplices are only projected onto), their union covering (0, 0, 0) with that point as a vertex: an example that
 * steps in place at zero rates (feet at their natural places and flat, feet rising some 4 cm in turn, hips and arms
 * nearly still), or else the idle example, which is then sampled on its own clock. Standing uses the idle example
 * (FF_EXAMPLE_IDLE) in either case; it need not be in a simplex. */
typedef struct ff_pack_simplex {
    int32_t vertex[4];
    uint32_t gait;
} ff_pack_simplex;

/* What the plant finder saw of a foot, for reports: index = 2 * (frame - number of example frames) + foot. The clips'
 * streams follow the examples' in STRM in CLIP order. Heel, ball, toe. Nothing at run time reads it. */
typedef struct ff_pack_track {
    int16_t height[3]; /* 0.1 mm, over the point's own rest level */
    int16_t speed[3];  /* mm/s, on the ground */
} ff_pack_track;

typedef struct ff_pack_point2 {
    float f, l; /* m/s, agent frame */
} ff_pack_point2;

/* How an example was closed to a loop. */
typedef struct ff_pack_loop {
    float cut;      /* phase at which the clip was cut, [0, 1) */
    float jump;     /* m, of any joint from the last to the first pose, after closing */
    float moved;    /* m, the furthest that closing moved any joint */
    float cut_kick; /* m/s, mean difference of the joints' velocities at the end from those at the start */
    float contact_kick; /* m/s, their change over the foot contact further from the cut; 0: standing */
} ff_pack_loop;

/* When a body may pass from one example to another, or to the semi-procedural clip at the example's own rates
 * (to = FF_CORRESPOND_GAIT), or back: times at which their poses agree (FbCrowd 5.1 and 10; algorithms A.12). from < to;
 * in order of from, then of to. */
#define FF_CORRESPOND_GAIT 0xffffffffu
enum { FF_CORRESPOND_KEYS = 1 }; /* the same events of the same foot, for want of enough minima */
typedef struct ff_pack_correspondence {
    uint32_t from, to; /* examples */
    uint32_t first_pair, pair_count;
    uint32_t flags;
    float wait[2]; /* s, longest wait for the next pair in either clip, at its own pace */
    float mean;    /* m, mean distance over the whole cycle along the warp through the pairs */
} ff_pack_correspondence;

/* One pair, in order of phase[0]; phase[1] advances once around with it. The pose of `to`, moved by shift (forward,
 * left) and turned by turn in the root frame of `from`, lies best on the pose of `from`. */
typedef struct ff_pack_pair {
    float phase[2]; /* [0, 1) */
    float distance; /* m, of the windows of 0.3 s, weighted (Kovar et al. 2002) */
    float rms;      /* m, root mean square over the joints at the pair itself */
    float turn;     /* rad */
    float shift[2]; /* m */
} ff_pack_pair;

/* The semi-procedural clip: one walking example, made the same on both sides and scaled to other rates (runtime/core/
 * gait_model.h). Laws are fitted to the pack's captured straight walks; each is exact at the clip's own speed. */
enum { FF_GAIT_LAW_LIFT, FF_GAIT_LAW_PITCH, FF_GAIT_LAW_BOB, FF_GAIT_LAW_SWAY, FF_GAIT_LAW_COUNT };
typedef struct ff_pack_gait {
    uint32_t example;    /* whose trunk, arms and knees it has */
    uint32_t walks;      /* how many examples the laws were fitted to */
    float speed, period; /* m/s, s: of the clip */
    float stance;        /* share of the cycle from a foot's contact to its toe-off, at the clip's speed */
    float ball_rest;     /* m */
    float centre[3];     /* ball in mid stance: forward, to its own side (m), toe-out (rad) */
    float stand[3];      /* the same of standing feet */
    float cadence;       /* period = clip's * (speed / clip's)^-cadence */
    float stance_slope;  /* stance = clip's + slope * (speed - clip's), per m/s */
    float law[FF_GAIT_LAW_COUNT];           /* amplitude = clip's * (1 + law * (step ratio - 1)) */
    float residual[FF_GAIT_LAW_COUNT];      /* root mean square, of the amplitude as a share of the clip's */
    float period_residual, stance_residual; /* s; share of the cycle */
    float ball_residual
        [3]; /* m, root mean square of the model's ball path against the walks': forward, left, up */
} ff_pack_gait;

/* Over one cycle from a foot's own contact; hips: from the left contact, the other half is its mirror image. */
#define FF_GAIT_SAMPLES 64
typedef struct ff_pack_gait_path {
    float ahead;   /* cycles' worth of root motion that the ball is ahead of its place in mid stance */
    float side;    /* m, further to its own side than in mid stance */
    float lift;    /* m, of the ball over its rest height */
    float yaw;     /* rad, outward, more than in mid stance */
    float pitch;   /* rad, toes up + */
    float hips[3]; /* forward, left (m), height over its mean (m) */
} ff_pack_gait_path;

/* Half-plane of velocities that stay allowed to who wants to turn round to one side: left of the line through point
 * along direction, in the agent's frame (algorithms A.11, step 5). */
typedef struct ff_pack_sharp {
    float point[2], direction[2]; /* m/s; unit */
    int32_t side;                 /* 1 left, -1 right */
} ff_pack_sharp;

#endif
