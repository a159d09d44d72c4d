/* run.h - `footfall-crowd run`: a scene on a pack, to files. */
#ifndef FF_RUN_H
#define FF_RUN_H

/* argv starts after the word "run". Returns the exit status. */
int ff_run_main(int argc, char **argv);

#endif
