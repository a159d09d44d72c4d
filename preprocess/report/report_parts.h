/* report_parts.h - the parts of the report's page. */
#ifndef FF_REPORT_PARTS_H
#define FF_REPORT_PARTS_H

#include "runtime/core/pack/pack.h"
#include "runtime/export/text.h"

#include <jansson.h>

/* Append text with the characters that mean something to HTML escaped; at most 480 bytes of it. */
void ff_report_text(ff_text *page, const char *text);

/* Names and colours of locomotion modes. */
const char *ff_report_mode(uint32_t mode);
const char *ff_report_colour(uint32_t mode);

/* World positions of a stream's pose: the joints, then the points of the pack (joint_count + point_count). */
void ff_report_pose(const ff_pack *pack, uint32_t stream, double seconds, ff_vec3 *positions);

/* Heights and speeds of both feet over time, plants shaded, actions and rejections below. entry: what META says of
 * the clip, or NULL. */
void ff_report_timeline(ff_text *page, const ff_pack *pack, const ff_pack_clip *clip, const json_t *entry);

/* One card per action of the clip: the body from the side at five moments, and the annotation. */
void ff_report_steps(ff_text *page, const ff_pack *pack, const ff_pack_clip *clip);

/* What the clean-up of a clip's feet did. clean: the clip's object in META, or NULL. */
void ff_report_clean(ff_text *page, const json_t *clean);

/* Where the actions land, how far they turn, what is missing, what may follow what. */
void ff_report_coverage(ff_text *page, const ff_pack *pack);

/* Examples and their hull in the plane of velocities (FbCrowd, figure 3). */
void ff_report_hull(ff_text *page, const ff_pack *pack);

/* Every example as strips of poses, the kinds of locomotion, and the semi-procedural clip; then the distance maps of
 * examples that correspond, with the moments found. */
ff_status ff_report_examples(ff_text *page, const ff_pack *pack, const json_t *meta, ff_error *error);
ff_status ff_report_maps(ff_text *page, const ff_pack *pack, ff_error *error);

#endif
