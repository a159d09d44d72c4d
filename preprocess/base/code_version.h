/* code_version.h - which code made something: a hash of the sources that results depend on, computed by the Makefile. */
#ifndef FF_CODE_VERSION_H
#define FF_CODE_VERSION_H

/* A hexadecimal number; another one whenever a source of mocap, preprocess or the runtime's core, the compiler or its
 * flags changed. */
const char *ff_code_version(void);

#endif
