#include "runtime/tool/nearest.h"

#include <stddef.h>
#include <string.h>

enum { LONGEST = 48 }; /* longer words are not typing mistakes of our short ones */

static size_t least(size_t x, size_t y)
{
    return x < y ? x : y;
}

/* Edits (insert, delete, replace) from p to q (Wagner and Fischer 1974), one row at a time. */
static size_t edit_distance(const char *p, size_t p_length, const char *q, size_t q_length)
{
    size_t row[LONGEST + 1];
    for (size_t j = 0; j <= q_length; ++j)
        row[j] = j;
    for (size_t i = 1; i <= p_length; ++i) {
        size_t diagonal = row[0];
        row[0] = i;
        for (size_t j = 1; j <= q_length; ++j) {
            size_t above = row[j];
            size_t replaced = diagonal + (p[i - 1] != q[j - 1]);
            row[j] = least(replaced, least(above, row[j - 1]) + 1);
            diagonal = above;
        }
    }
    return row[q_length];
}

const char *ff_nearest(const char *word, const char *const *choices)
{
    size_t length = strlen(word);
    if (length > LONGEST) return NULL;
    size_t allowed = length / 3 > 1 ? length / 3 : 1;
    const char *best = NULL;
    for (; *choices; ++choices) {
        size_t other = strlen(*choices);
        if (other > LONGEST) continue;
        size_t distance = edit_distance(word, length, *choices, other);
        if (distance > allowed) continue;
        best = *choices;
        if (distance == 0) break;
        allowed = distance - 1; /* from here on only a nearer one wins */
    }
    return best;
}
