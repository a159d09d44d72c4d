/* extract_command.h - footfall-pack extract: any action, example or clip of a pack back to BVH or glTF. */
#ifndef FF_EXTRACT_COMMAND_H
#define FF_EXTRACT_COMMAND_H

int ff_extract_command(int argc, char **argv);

#endif
