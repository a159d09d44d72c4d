/* tree.h - the joints of a clip as a tree: children in order, and a walk through them without recursion. */
#ifndef FF_TREE_H
#define FF_TREE_H

#include "mocap/clip.h"

typedef struct ff_tree {
    int *first_child, *next_sibling; /* [joint_count], -1 = none; roots are siblings of each other */
    int *order;                      /* [joint_count] depth first */
    int *depth;                      /* [joint_count] of a joint, 0 for roots */
} ff_tree;

ff_status ff_tree_build(const ff_clip *clip, ff_tree *out, ff_error *error);
void ff_tree_free(ff_tree *tree);

#endif
