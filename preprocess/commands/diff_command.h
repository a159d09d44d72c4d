/* diff_command.h - footfall-pack diff: what changed from one pack to another, in words. */
#ifndef FF_DIFF_COMMAND_H
#define FF_DIFF_COMMAND_H

int ff_diff_command(int argc, char **argv);

#endif
