/* Scene files: whatever is let through can be laid out, inside the world and without nan. */
#include "runtime/export/scene.h"

#include <math.h>
#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static bool is_sane(const ff_scene *scene)
{
    for (uint32_t i = 0; i < ff_scene_agent_count(scene); ++i) {
        const ff_scene_agent *agent = &ff_scene_agents(scene)[i];
        double sum = agent->position.a + agent->position.b + agent->goal.a + agent->goal.b + agent->heading;
        if (!isfinite(sum) || !(agent->radius > 0.0) || !(agent->preferred_speed > 0.0)) return false;
    }
    return scene->most > 0 && scene->most_numbers >= ff_scene_agent_count(scene) && scene->seconds > 0.0 &&
           scene->step > 0.0;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    ff_error error;
    ff_scene_def def;
    ff_scene scene;
    if (ff_scene_def_parse((const char *)data, size, "fuzz.json", &def, &error) != FF_OK) return 0;
    if (def.kind != FF_SCENE_CUSTOM && def.agents > 300) def.agents = 300; /* placing is quadratic */
    ff_scene_group *groups = def.crowds.data;
    for (size_t i = 0; i < def.crowds.count; ++i)
        if (groups[i].count > 40) groups[i].count = 40;
    if (ff_scene_create(&def, &scene, &error) == FF_OK) {
        if (!is_sane(&scene)) abort();
        ff_scene_free(&scene);
    }
    ff_scene_def_free(&def);
    return 0;
}
