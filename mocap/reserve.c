/* Room for the frames of a clip while its file is read. */
#include "mocap/read.h"
#include "runtime/core/base/fail.h"

#include <stdlib.h>

/* 2 GB of rotations: over three hours of 43 joints at 120 frames/s. */
#define MOST_ROTATIONS ((size_t)1 << 26)

static bool resize(ff_clip *clip, size_t frames)
{
    size_t joints = (size_t)clip->joint_count, tracks = (size_t)clip->track_count;
    void *rotations = realloc(clip->rotations, frames * joints * sizeof *clip->rotations);
    if (rotations) clip->rotations = rotations;
    void *positions = tracks ? realloc(clip->positions, frames * tracks * sizeof *clip->positions) : NULL;
    if (positions) clip->positions = positions;
    return rotations && (positions || !tracks);
}

ff_status ff_clip_reserve(ff_clip *clip, int *capacity, int needed, int guess, ff_error *error)
{
    if (needed <= *capacity) return FF_OK;
    size_t most = MOST_ROTATIONS / (size_t)clip->joint_count;
    if ((size_t)needed > most)
        return ff_fail(error, FF_ERR_RANGE, "more than %zu frames of %d joints: cut the clip in pieces", most,
                       clip->joint_count);
    size_t frames = (size_t)(guess > needed ? guess : needed);
    size_t grown = (size_t)*capacity + (size_t)*capacity / 2;
    if (frames < grown) frames = grown;
    if (frames > most) frames = most;
    if (!resize(clip, frames)) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for %zu frames", frames);
    *capacity = (int)frames;
    return FF_OK;
}

void ff_clip_trim(ff_clip *clip, int capacity)
{
    if (capacity > clip->frame_count) resize(clip, (size_t)clip->frame_count);
}

ff_status ff_clip_read_end(ff_status status, const char *name, ff_clip *out, ff_error *error)
{
    out->unit_m = 1.0;
    if (status == FF_OK) return FF_OK;
    ff_error_in_file(error, name);
    ff_clip_free(out);
    return status;
}
