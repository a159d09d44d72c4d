/* import_command.h - footfall-pack import: clips of any kind as BVH in one form, and what they are. */
#ifndef FF_IMPORT_COMMAND_H
#define FF_IMPORT_COMMAND_H

int ff_import_command(int argc, char **argv);

#endif
