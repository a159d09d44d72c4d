/* recipes.h - the list of built-in clips and the plan of each (internal to the generator). */
#ifndef FF_RECIPES_H
#define FF_RECIPES_H

#include "mocap/generator/generator.h"
#include "mocap/generator/plan.h"

typedef struct ff_recipe ff_recipe;
struct ff_recipe {
    ff_generator_info info;
    int (*plan)(const ff_recipe *recipe,
                ff_plan *plan);    /* fills knots and contacts, returns the frame count */
    void (*adjust)(ff_plan *plan); /* after ff_plan_finish; may be NULL */
    double amount;                 /* what the kind of clip needs: angle of a turn, ... */
    int foot;                      /* that starts (start) or closes (stop): 0 left, 1 right */
    bool reversed;                 /* planned forward and played backward */
    ff_plan_style style;
};

extern const ff_recipe ff_recipes[];
extern const int ff_recipe_count;

#endif
