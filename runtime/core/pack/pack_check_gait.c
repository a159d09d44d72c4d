#include "runtime/core/pack/pack_check.h"

#include "runtime/core/base/fail.h"

#define LIMIT_BODY 10.0f /* m, rad */
#define LIMIT_TIME 120.0f
#define LIMIT_SPEED 50.0f

static ff_status check_loops(const ff_pack *pack, ff_error *error)
{
    if (pack->loop_count != 0 && pack->loop_count != pack->example_count)
        return FF_PACK_REFUSE("LOOP", pack->loops, "%u loops for %u examples", pack->loop_count,
                              pack->example_count);
    for (uint32_t i = 0; i < pack->loop_count; ++i) {
        const ff_pack_loop *loop = &pack->loops[i];
        const float *wild = ff_pack_wild_float(&loop->cut, 1, 1.0f);
        if (!wild) wild = ff_pack_wild_float(&loop->jump, 4, LIMIT_SPEED);
        if (wild) return FF_PACK_REFUSE("LOOP", wild, "loop %u: %g", i, (double)*wild);
    }
    return FF_OK;
}

static ff_status check_pair(const ff_pack *pack, uint32_t index, ff_error *error)
{
    const ff_pack_pair *pair = &pack->pairs[index];
    for (int i = 0; i < 2; ++i)
        if (!(pair->phase[i] >= 0.0f && pair->phase[i] < 1.0f))
            return FF_PACK_REFUSE("PAIR", &pair->phase[i], "pair %u: phase %g, expected 0 to 1", index,
                                  (double)pair->phase[i]);
    const float *wild = ff_pack_wild_float(&pair->distance, 5, LIMIT_BODY);
    if (wild) return FF_PACK_REFUSE("PAIR", wild, "pair %u: %g", index, (double)*wild);
    return FF_OK;
}

/* The pairs of a correspondence go once around both cycles in the same direction. */
static ff_status check_order(const ff_pack *pack, const ff_pack_correspondence *c, uint32_t index,
                             ff_error *error)
{
    uint32_t backwards = 0;
    for (uint32_t k = 0; k < c->pair_count; ++k) {
        const ff_pack_pair *pair = &pack->pairs[c->first_pair + k];
        const ff_pack_pair *next = &pack->pairs[c->first_pair + (k + 1) % c->pair_count];
        if (k + 1 < c->pair_count && !(next->phase[0] > pair->phase[0]))
            return FF_PACK_REFUSE("PAIR", next, "correspondence %u: phase %g after %g", index,
                                  (double)next->phase[0], (double)pair->phase[0]);
        if (c->pair_count > 1 && !(next->phase[1] > pair->phase[1])) ++backwards;
    }
    if (backwards > 1)
        return FF_PACK_REFUSE("CORR", c, "correspondence %u: its pairs do not go around once", index);
    return FF_OK;
}

static ff_status check_correspondence(const ff_pack *pack, uint32_t index, uint32_t *next_pair,
                                      ff_error *error)
{
    const ff_pack_correspondence *c = &pack->correspondences[index];
    bool gait = c->to == FF_CORRESPOND_GAIT;
    if (c->from >= pack->example_count || (!gait && (c->to >= pack->example_count || c->to <= c->from)) ||
        (gait && pack->gait_count == 0))
        return FF_PACK_REFUSE("CORR", c, "correspondence %u: from example %u to %u of %u", index, c->from,
                              c->to, pack->example_count);
    if (index > 0) {
        const ff_pack_correspondence *last = c - 1;
        if (c->from < last->from || (c->from == last->from && c->to <= last->to))
            return FF_PACK_REFUSE("CORR", c, "correspondence %u: not in order of its examples", index);
    }
    if (c->first_pair != *next_pair || c->pair_count == 0 ||
        !ff_pack_range_fits(c->first_pair, c->pair_count, pack->pair_count))
        return FF_PACK_REFUSE("CORR", &c->first_pair, "correspondence %u: pairs %u + %u of %u", index,
                              c->first_pair, c->pair_count, pack->pair_count);
    *next_pair += c->pair_count;
    if (c->flags & ~(uint32_t)FF_CORRESPOND_KEYS)
        return FF_PACK_REFUSE("CORR", &c->flags, "correspondence %u: unknown flags %x", index, c->flags);
    const float *wild = ff_pack_wild_float(c->wait, 3, LIMIT_TIME);
    if (wild) return FF_PACK_REFUSE("CORR", wild, "correspondence %u: %g", index, (double)*wild);
    return check_order(pack, c, index, error);
}

static ff_status check_model(const ff_pack *pack, ff_error *error)
{
    if (pack->gait_count > 1 || pack->gait_path_count != pack->gait_count * FF_GAIT_SAMPLES)
        return FF_PACK_REFUSE("GAIT", pack->data, "%u gait models with %u samples, expected one with %d",
                              pack->gait_count, pack->gait_path_count, FF_GAIT_SAMPLES);
    for (uint32_t i = 0; i < pack->gait_path_count; ++i) {
        const float *wild = ff_pack_wild_float(&pack->gait_path[i].ahead, 8, LIMIT_BODY);
        if (wild) return FF_PACK_REFUSE("GPTH", wild, "sample %u: %g", i, (double)*wild);
    }
    if (pack->gait_count == 0) return FF_OK;
    const ff_pack_gait *gait = pack->gait;
    if (gait->example >= pack->example_count)
        return FF_PACK_REFUSE("GAIT", &gait->example, "example %u of %u", gait->example, pack->example_count);
    if (!(gait->speed >= 0.1f && gait->speed <= LIMIT_SPEED))
        return FF_PACK_REFUSE("GAIT", &gait->speed, "speed %g m/s", (double)gait->speed);
    if (!(gait->period >= 0.2f && gait->period <= 10.0f))
        return FF_PACK_REFUSE("GAIT", &gait->period, "period %g s", (double)gait->period);
    if (!(gait->stance >= 0.2f && gait->stance <= 0.9f))
        return FF_PACK_REFUSE("GAIT", &gait->stance, "stance %g of the cycle", (double)gait->stance);
    const float *wild = ff_pack_wild_float(
        &gait->ball_rest, (sizeof *gait - offsetof(ff_pack_gait, ball_rest)) / 4, LIMIT_BODY);
    if (wild) return FF_PACK_REFUSE("GAIT", wild, "%g", (double)*wild);
    return FF_OK;
}

static ff_status check_sharp(const ff_pack *pack, ff_error *error)
{
    for (uint32_t i = 0; i < pack->sharp_count; ++i) {
        const ff_pack_sharp *line = &pack->sharp[i];
        const float *wild = ff_pack_wild_float(line->point, 2, LIMIT_SPEED);
        double length = ff_length2(ff_v2((double)line->direction[0], (double)line->direction[1]));
        if (wild || !(fabs(length - 1.0) < 1e-3) || (line->side != 1 && line->side != -1))
            return FF_PACK_REFUSE("SHRP", line, "line %u: direction of length %g, side %d", i, length,
                                  line->side);
    }
    return FF_OK;
}

ff_status ff_pack_check_gait(const ff_pack *pack, ff_error *error)
{
    ff_status status = check_loops(pack, error);
    if (status == FF_OK) status = check_model(pack, error);
    for (uint32_t i = 0; i < pack->pair_count && status == FF_OK; ++i)
        status = check_pair(pack, i, error);
    uint32_t next_pair = 0;
    for (uint32_t i = 0; i < pack->correspondence_count && status == FF_OK; ++i)
        status = check_correspondence(pack, i, &next_pair, error);
    if (status == FF_OK && next_pair != pack->pair_count)
        status = FF_PACK_REFUSE("PAIR", pack->pairs, "%u pairs, correspondences use %u", pack->pair_count,
                                next_pair);
    if (status == FF_OK) status = check_sharp(pack, error);
    return status;
}
