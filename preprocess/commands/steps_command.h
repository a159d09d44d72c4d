/* steps_command.h - `footfall-pack steps`: how clips are walked, in numbers. */
#ifndef FF_STEPS_COMMAND_H
#define FF_STEPS_COMMAND_H

/* Returns the exit status. */
int ff_steps_command(int argc, char **argv);

#endif
