/* standard.h - the settings at their defaults, for tests of single stages. */
#ifndef FF_STANDARD_H
#define FF_STANDARD_H

#include "preprocess/build/settings.h"

static inline const ff_settings *standard(void)
{
    static ff_settings settings;
    static bool made;
    if (!made) settings = ff_settings_default();
    made = true;
    return &settings;
}

#endif
