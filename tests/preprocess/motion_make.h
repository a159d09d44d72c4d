/* motion_make.h - a clip with its plants and its motion on a rig, for the tests of what is made from motions. */
#ifndef FF_MOTION_MAKE_H
#define FF_MOTION_MAKE_H

#include "mocap/generator/generator.h"
#include "preprocess/motion/motion.h"
#include "tests/preprocess/clip_change.h"
#include "tests/preprocess/standard.h"

typedef struct made_motion {
    ff_clip clip;
    ff_plants plants;
    ff_motion motion;
} made_motion;

static inline ff_clip generated_clip(const char *name)
{
    ff_generated made;
    ff_error error;
    int index = ff_generator_find(name);
    assert_true(index >= 0);
    FF_ASSERT_OK(ff_generator_make(index, NULL, &made, &error), error);
    ff_clip clip = made.clip;
    memset(&made.clip, 0, sizeof made.clip);
    ff_generated_free(&made);
    return clip;
}

static inline ff_rig rig_of(const ff_clip *clip)
{
    ff_rig rig;
    ff_error error;
    FF_ASSERT_OK(ff_rig_from_clips(&clip, 1, &rig, &error), error);
    return rig;
}

static inline ff_rig rig_of_generated(const char *name)
{
    ff_clip clip = generated_clip(name);
    ff_rig rig = rig_of(&clip);
    ff_clip_free(&clip);
    return rig;
}

/* The clip's motion; made owns the clip from now on. */
static inline made_motion make_motion(const ff_rig *rig, ff_clip clip)
{
    made_motion made;
    ff_error error;
    made.clip = clip;
    FF_ASSERT_OK(ff_plants_find(&made.clip, &standard()->find, &made.plants, &error), error);
    FF_ASSERT_OK(ff_motion_from_clip(rig, &made.clip, &made.plants, &made.motion, &error), error);
    return made;
}

static inline void made_motion_free(made_motion *made)
{
    ff_clip_free(&made->clip);
    ff_plants_free(&made->plants);
    ff_motion_free(&made->motion);
}

#endif
