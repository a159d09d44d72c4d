#include "preprocess/commands/steps_command.h"

#include "preprocess/actions/gait_figures.h"
#include "preprocess/commands/each_clip.h"
#include "runtime/tool/command_line.h"

#include <stdio.h>

static const char *const PROGRAM = "footfall-pack";

static ff_status print_row(const ff_seen_clip *seen, void *context, ff_error *error)
{
    const bool *csv = context;
    ff_gait_figures f;
    ff_status status = ff_gait_figures_find(&seen->clip, &seen->plants, &f, error);
    if (status != FF_OK) return status;
    if (*csv)
        printf("%s,%d,%.6g,%.4f,%d,%d,%d,%d,%d,%.2f,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f,%.2f\n", seen->clip.name,
               seen->clip.frame_count, 1.0 / seen->clip.frame_time, f.seconds, f.contacts, f.initial_contacts,
               f.steps, f.first_ic, f.last_ic, f.cadence, f.stride_time, f.speed_net, f.speed_path,
               f.step_length, f.step_length_sd, f.step_width, f.turn / FF_DEG);
    else
        printf("%-32.32s %6.2f %6d %8.1f %8.2f %8.2f %8.1f %8.0f\n", seen->clip.name, f.seconds, f.steps,
               f.cadence, f.speed_path, f.step_length, 100.0 * f.step_width, f.turn / FF_DEG);
    return FF_OK;
}

int ff_steps_command(int argc, char **argv)
{
    bool csv = false;
    ff_clip_run run = {.program = PROGRAM, .what = "steps"};
    ff_option options[] = {{.name = "--csv", .help = "one line per clip, with a header", .flag = &csv},
                           FF_CONFIG_OPTION(run),
                           FF_QUIET_OPTION(run),
                           {0}};
    ff_command command = {
        .program = PROGRAM,
        .name = "steps",
        .arguments = "CLIP|FOLDER|CATALOGUE...",
        .summary = "how clips are walked: steps, cadence, speed, step length, turn",
        .details =
            "Steps are contacts whose beginning the clip shows, less one. Speed is that of the hips along "
            "their way\n"
            "on the ground; a step is measured from ball to ball of the other foot, along the way; the turn "
            "is "
            "the\n"
            "pelvis' at the last frame less at the first, left positive.",
        .options = options,
        .min_operands = 1,
        .max_operands = -1,
    };
    ff_operands operands;
    int result = ff_command_parse(&command, argc, argv, &operands);
    if (result >= 0) return result;
    if (csv)
        printf(
            "clip,n_frames,fps,duration_s,n_contacts,n_initial_contacts,n_single_steps,first_ic_frame,"
            "last_ic_frame,cadence_spm,stride_time_s,speed_net_mps,speed_path_mps,step_len_m,step_len_sd_m,"
            "step_width_m,pelvis_yaw_first_to_last_deg\n");
    else
        printf("%-32s %6s %6s %8s %8s %8s %8s %8s\n", "clip", "s", "steps", "per min", "m/s", "step m",
               "width cm", "turn deg");
    return ff_each_clip(&run, &operands, print_row, &csv);
}
