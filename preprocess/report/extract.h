/* extract.h - a part of a pack as a recording of one person, for the runtime's exporters. */
#ifndef FF_EXTRACT_H
#define FF_EXTRACT_H

#include "runtime/core/pack/pack.h"
#include "runtime/export/recording.h"

typedef enum ff_part_kind { FF_PART_ACTION, FF_PART_EXAMPLE, FF_PART_CLIP } ff_part_kind;

typedef struct ff_part {
    ff_part_kind kind;
    uint32_t index; /* into ACTN, EXMP or CLIP */
} ff_part;

/* What a person names: a number or action:NUMBER, example:NUMBER, clip:NUMBER, or the name of an example or clip (alone
 * or after its word). On failure error lists what there is. */
ff_status ff_part_find(const ff_pack *pack, const char *name, ff_part *out, ff_error *error);

/* "action 12 (long step, mirrored, of 16_17)" */
void ff_part_say(const ff_pack *pack, ff_part part, char *text, size_t size);

/* Its poses at rate (Hz), the last moment included: from t_0 to t_end of an action (with sides exchanged when it is a
 * mirrored one), cycles rounds of an example on its constant-rate root, all of a clip. The motion starts over the origin,
 * facing +Z. The caller frees *out. */
ff_status ff_part_record(const ff_pack *pack, ff_part part, double rate, int cycles, ff_recording *out,
                         ff_error *error);

#endif
