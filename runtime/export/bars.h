/* bars.h - figures of several methods in several scenes as bars, panel by panel. */
#ifndef FF_BARS_H
#define FF_BARS_H

#include "runtime/export/picture.h"

#define FF_BARS_MAX 8 /* methods */

typedef struct ff_bar_panel {
    const char *title, *unit;
    const double *values; /* [group][method] */
} ff_bar_panel;

typedef struct ff_bar_chart {
    const char *title, *subtitle;
    const char *const *groups, *const *methods;
    int group_count, method_count, panel_count;
    const ff_bar_panel *panels;
} ff_bar_chart;

ff_status ff_bars_write(const char *path, const ff_bar_chart *chart, ff_error *error);

#endif
