#include "mocap/tree.h"

#include "runtime/core/base/fail.h"
#include "runtime/core/base/memory.h"

#include <stdlib.h>
#include <string.h>

static void link_children(const ff_clip *clip, ff_tree *tree)
{
    int first_root = -1;
    for (int j = clip->joint_count - 1; j >= 0; --j) {
        int parent = clip->joints[j].parent;
        int *first = parent < 0 ? &first_root : &tree->first_child[parent];
        tree->next_sibling[j] = *first;
        *first = j;
        tree->depth[j] = 0;
    }
    for (int j = 0; j < clip->joint_count; ++j)
        if (clip->joints[j].parent >= 0) tree->depth[j] = tree->depth[clip->joints[j].parent] + 1;
}

static void walk(const ff_clip *clip, ff_tree *tree)
{
    int count = 0;
    for (int j = 0; j >= 0;) {
        tree->order[count++] = j;
        int next = tree->first_child[j];
        for (; next < 0 && j >= 0; j = clip->joints[j].parent)
            next = tree->next_sibling[j];
        j = next;
    }
}

ff_status ff_tree_build(const ff_clip *clip, ff_tree *out, ff_error *error)
{
    size_t count = (size_t)clip->joint_count;
    for (int j = 0; j < clip->joint_count; ++j)
        if (clip->joints[j].parent >= j ||
            (clip->joints[j].parent >= 0 && clip->joints[clip->joints[j].parent].end_site))
            return ff_fail(error, FF_ERR_ARGUMENT,
                           "joint %d does not follow its parent, or hangs from an end site", j);
    if (count == 0) return ff_fail(error, FF_ERR_ARGUMENT, "the clip has no joints");
    int *all = ff_calloc(4 * count, sizeof *all);
    if (!all) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for %zu joints", count);
    *out = (ff_tree){all, all + count, all + 2 * count, all + 3 * count};
    memset(out->first_child, 0xff, count * sizeof *all); /* -1 */
    link_children(clip, out);
    walk(clip, out);
    return FF_OK;
}

void ff_tree_free(ff_tree *tree)
{
    free(tree->first_child);
    memset(tree, 0, sizeof *tree);
}
