/* setting_rows.h - whether the rows of the settings' table change results. */
#ifndef FF_SETTING_ROWS_H
#define FF_SETTING_ROWS_H

#include "tests/check.h"
#include "tests/preprocess/standard.h"

#include <xxhash.h>

static ff_error error;

static inline uint64_t mix(const void *data, size_t size, uint64_t seed)
{
    return size > 0 ? XXH64(data, size, seed) : seed + 1;
}

static inline void set(ff_settings *settings, const ff_setting *row, double value)
{
    void *place = (char *)settings + row->place;
    if (row->kind == FF_SETTING_NUMBER) *(double *)place = value;
    if (row->kind == FF_SETTING_WHOLE) *(int64_t *)place = (int64_t)value;
    if (row->kind == FF_SETTING_SWITCH) *(bool *)place = value != 0.0;
}

typedef uint64_t result_of(const ff_settings *settings);

/* Either end of the row's range, or a small whole number, gives something else than its default. */
static inline bool row_matters(const ff_setting *row, result_of *result, uint64_t usual)
{
    const double values[] = {row->low, row->high, 5.0};
    for (int i = 0; i < (row->kind == FF_SETTING_WHOLE ? 3 : 2); ++i) {
        ff_settings changed = *standard();
        set(&changed, row, values[i]);
        if (result(&changed) != usual) return true;
    }
    print_error("%s.%s: its range, %g to %g, changes nothing\n", row->section, row->key, row->low, row->high);
    return false;
}

/* Rows whose key has `but` in it (NULL: none) are left out. */
static inline void assert_rows_matter_but(const char *const *sections, const char *but, result_of *result)
{
    uint64_t usual = result(standard());
    bool all = true;
    assert_true(result(standard()) == usual);
    for (; *sections; ++sections) {
        int rows = 0;
        for (int i = 0; i < ff_setting_count; ++i) {
            const ff_setting *row = &ff_setting_table[i];
            if (strcmp(row->section, *sections) != 0 || (but && strstr(row->key, but))) continue;
            all = row_matters(row, result, usual) && all;
            ++rows;
        }
        assert_true(rows > 0);
    }
    assert_true(all);
}

static inline void assert_rows_matter(const char *const *sections, result_of *result)
{
    assert_rows_matter_but(sections, NULL, result);
}

#endif
