/* walk.c - twenty people on a circle, each walking to the other side. usage: walk PACK */
#include <footfall.h>

#include <math.h>
#include <stdio.h>

enum { PEOPLE = 20 };

static int fail(const ff_error *error)
{
    char text[512];
    fprintf(stderr, "walk: %s\n", ff_error_text(error, text, sizeof text));
    return 1;
}

int main(int argc, char **argv)
{
    ff_error error;
    ff_pack *pack;
    ff_crowd *crowd;
    ff_agent agents[PEOPLE];
    if (argc != 2) return fprintf(stderr, "usage: walk PACK\n"), 2;
    if (ff_pack_open(argv[1], &pack, &error) != FF_OK) return fail(&error);

    ff_crowd_def def = ff_crowd_def_default();
    def.max_agents = PEOPLE;
    if (ff_crowd_create(pack, &def, &crowd, &error) != FF_OK) return fail(&error);

    for (int i = 0; i < PEOPLE; ++i) {
        double angle = 6.283185307179586 * i / PEOPLE;
        ff_agent_def person = ff_agent_def_default();
        person.position = (ff_vec2){-8.0 * cos(angle), -8.0 * sin(angle)};
        person.goal = (ff_vec2){8.0 * cos(angle), 8.0 * sin(angle)};
        person.heading = angle;
        if (ff_crowd_add_agent(crowd, &person, &agents[i], &error) != FF_OK) return fail(&error);
    }

    int reached = 0;
    while (reached < PEOPLE && ff_crowd_step_count(crowd) < 3000) {
        ff_crowd_step(crowd);
        reached = 0;
        for (int i = 0; i < PEOPLE; ++i) {
            ff_agent_state state;
            if (ff_crowd_agent_state(crowd, agents[i], &state, &error) != FF_OK) return fail(&error);
            reached += state.reached; /* for drawing, ask for the pose: ff_crowd_agent_pose */
        }
    }
    printf("%d of %d reached the other side in %.1f s, state %016llx\n", reached, PEOPLE,
           (double)ff_crowd_step_count(crowd) * def.step, (unsigned long long)ff_crowd_state_hash(crowd));
    ff_crowd_destroy(crowd);
    ff_pack_close(pack);
    return reached == PEOPLE ? 0 : 1;
}
