/* wander.c - people who walk to one random goal after the other; prints the hash of the state every so often.
 *
 *   wander PACK AGENTS STEPS THREADS
 *
 * The output must not depend on THREADS: 0 stands for a caller's scheduler that runs the tasks backwards. */
#include "runtime/core/base/random.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

enum { EVERY = 100 /* steps between two printed hashes */, MOST = 1000 };
#define FIELD 6.0 /* m, half the side of the square they walk in */

static void backwards(void *pool, uint32_t count, void (*function)(void *context, uint32_t index),
                      void *context)
{
    (void)pool;
    while (count > 0)
        function(context, --count);
}

static ff_vec2 somewhere(ff_random *random)
{
    double a = ff_random_range(random, -FIELD, FIELD);
    return (ff_vec2){a, ff_random_range(random, -FIELD, FIELD)};
}

static int fail(const ff_error *error)
{
    char text[1024];
    fprintf(stderr, "wander: %s\n", ff_error_text(error, text, sizeof text));
    return 1;
}

static int wander(ff_crowd *crowd, uint32_t count, long steps)
{
    static ff_agent agents[MOST];
    ff_random random = {.seed = 5};
    ff_error error;
    for (uint32_t i = 0; i < count; ++i) {
        ff_agent_def person = ff_agent_def_default();
        person.position = somewhere(&random);
        person.goal = somewhere(&random);
        person.preferred_speed = ff_random_range(&random, 0.9, 1.6);
        if (ff_crowd_add_agent(crowd, &person, &agents[i], &error) != FF_OK) return fail(&error);
    }
    for (long step = 1; step <= steps; ++step) {
        ff_crowd_step(crowd);
        for (uint32_t i = 0; i < count; ++i) {
            ff_agent_state state;
            if (ff_crowd_agent_state(crowd, agents[i], &state, &error) != FF_OK) return fail(&error);
            if (state.reached) ff_crowd_set_goal(crowd, agents[i], somewhere(&random), NULL);
        }
        if (step % EVERY == 0) printf("%ld %016" PRIx64 "\n", step, ff_crowd_state_hash(crowd));
    }
    return 0;
}

int main(int argc, char **argv)
{
    ff_error error;
    ff_pack *pack;
    ff_crowd *crowd;
    if (argc != 5) return fputs("usage: wander PACK AGENTS STEPS THREADS\n", stderr), 2;
    uint32_t count = (uint32_t)strtoul(argv[2], NULL, 10), threads = (uint32_t)strtoul(argv[4], NULL, 10);
    if (count > MOST) return fputs("wander: too many agents\n", stderr), 2;
    if (ff_pack_open(argv[1], &pack, &error) != FF_OK) return fail(&error);
    ff_crowd_def def = ff_crowd_def_default();
    def.max_agents = count;
    def.threads = threads;
    if (threads == 0) {
        def.threads = 1;
        def.tasks = backwards;
    }
    int status = 1;
    if (ff_crowd_create(pack, &def, &crowd, &error) == FF_OK) {
        status = wander(crowd, count, strtol(argv[3], NULL, 10));
        ff_crowd_destroy(crowd);
    } else {
        fail(&error);
    }
    ff_pack_close(pack);
    return status;
}
