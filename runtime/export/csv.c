#include "runtime/export/csv.h"

#include "runtime/export/text.h"

ff_status ff_csv_write(const char *path, const ff_scene *scene, const ff_recording *recording,
                       double interval, ff_error *error)
{
    const ff_scene_agent *agents = ff_scene_agents(scene);
    uint32_t stride = (uint32_t)ff_max(1.0, floor(interval / recording->step + 0.5));
    ff_text text = {0};
    ff_text_add(&text, "time,id,x,z,heading,speed,goal_x,goal_z,radius,reached\n");
    for (uint32_t step = 0; step < recording->step_count; step += stride) {
        for (uint32_t i = 0; i < recording->agent_count; ++i) {
            const ff_track *track = ff_recording_track(recording, step, i);
            if (!track->present) continue;
            ff_text_add(&text, "%.3f,%u,%.4f,%.4f,%.4f,%.3f,%.3f,%.3f,%.3f,%d\n",
                        recording->start + step * recording->step, i, track->position.b, track->position.a,
                        (double)track->heading, (double)track->speed, agents[i].goal.b, agents[i].goal.a,
                        agents[i].radius, track->reached);
        }
    }
    return ff_text_write(&text, path, error);
}
