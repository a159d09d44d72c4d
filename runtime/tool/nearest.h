/* nearest.h - the known word somebody probably meant. */
#ifndef FF_NEAREST_H
#define FF_NEAREST_H

/* The element of choices (NULL-terminated) nearest to word by edit distance, or NULL when none is near: at most a
 * third of word's letters may differ, and one always may. */
const char *ff_nearest(const char *word, const char *const *choices);

#endif
