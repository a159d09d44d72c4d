#include "preprocess/base/code_version.h"

const char *ff_code_version(void)
{
#ifdef FF_CODE_VERSION
    return FF_CODE_VERSION;
#else
    return "unknown";
#endif
}
