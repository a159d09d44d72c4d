/* clean_command.h - footfall-pack clean: what the clean-up does to clips, measured. */
#ifndef FF_CLEAN_COMMAND_H
#define FF_CLEAN_COMMAND_H

/* argv after the command's name; returns the exit status. */
int ff_clean_command(int argc, char **argv);

#endif
