/* validate_command.h - footfall-pack validate: is a pack sound in itself, and what its clips say? */
#ifndef FF_VALIDATE_COMMAND_H
#define FF_VALIDATE_COMMAND_H

int ff_validate_command(int argc, char **argv);

#endif
