/* stage.h - people of a recording, drawn by the software renderer. */
#ifndef FF_STAGE_H
#define FF_STAGE_H

#include "runtime/export/body_mesh.h"
#include "runtime/export/look.h"
#include "runtime/export/raster.h"
#include "runtime/export/recording.h"

/* A body and room for its vertices; one person at a time. */
typedef struct ff_stage {
    const ff_figure *figure; /* borrowed */
    ff_body_mesh mesh;
    ff_vec3 *positions, *normals;
    ff_shaded_vertex *vertices;
} ff_stage;

ff_status ff_stage_create(const ff_figure *figure, double cell, ff_stage *out, ff_error *error);
void ff_stage_destroy(ff_stage *stage);

/* Put the body into a recorded pose; joints (may be NULL) receives where they are. */
void ff_stage_pose(ff_stage *stage, const ff_recording *recording, uint32_t pose, uint32_t agent,
                   ff_vec3 *joints);
/* Colour it as dressed, or left and right limbs apart. */
void ff_stage_dress(ff_stage *stage, const ff_look *look);
void ff_stage_mark_sides(ff_stage *stage, ff_colour left, ff_colour right, ff_colour trunk);
void ff_stage_draw(const ff_stage *stage, ff_raster *raster, const ff_camera *camera);
void ff_stage_shadow(const ff_stage *stage, ff_raster *raster, const ff_camera *camera);

#endif
