/* plants_command.h - `footfall-pack plants`. */
#ifndef FF_PLANTS_COMMAND_H
#define FF_PLANTS_COMMAND_H

/* argv[0..argc) without the command's own name; returns the exit status. */
int ff_plants_command(int argc, char **argv);

#endif
