/* How well foot plants are found: against hand-checked labels of captured clips (when the outside data is there), as they
 * are and with the floor raised, tilted, and with noise; and against the truth of the built-in clips. */
#include "mocap/generator/generator.h"
#include "tests/preprocess/clip_change.h"
#include "tests/preprocess/plant_score.h"
#include "tests/preprocess/standard.h"

static void raise_floor(ff_clip *clip)
{
    clip_move(clip, FF_QUAT_IDENTITY, ff_v3(0.0, 0.1, 0.0));
}

static void tilt(ff_clip *clip)
{
    clip_move(clip, ff_quat_axis(ff_unit3(ff_v3(1.0, 0.0, 0.6)), 2.0 * FF_DEG), ff_v3(0.0, 0.0, 0.0));
}

static void shake(ff_clip *clip)
{
    clip_shake(clip, 0.002, 7);
}

static void print_scores(const char *shared)
{
    static const struct {
        const char *what;
        void (*change)(ff_clip *);
    } cases[] = {{"as captured", NULL},
                 {"floor 10 cm higher", raise_floor},
                 {"tilted by 2 degrees", tilt},
                 {"2 mm of noise", shake}};
    static const char *const kinds[2] = {"walk", "run"}, *const edges[EDGE_COUNT] = {
                                                             "start", "end", "flat start", "flat end"};
    static score sum;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        score_all(shared, cases[i].change, &sum);
        printf("%-20s F1 at IoU 0.5 and 0.8: walk %.4f %.4f, run %.4f %.4f\n", cases[i].what, f1(&sum, 0, 0),
               f1(&sum, 0, 1), f1(&sum, 1, 0), f1(&sum, 1, 1));
        for (int kind = 0; kind < 2 && i == 0; ++kind)
            for (int edge = 0; edge < EDGE_COUNT; ++edge)
                printf("  %-4s %-10s: median %+d frames, within %d: %.3f (%d)\n", kinds[kind], edges[edge],
                       edge_median(&sum, kind, edge), edge < EDGE_FLAT_START ? 6 : 10,
                       edge_within(&sum, kind, edge, edge < EDGE_FLAT_START ? 6 : 10), sum.edges[kind][edge]);
    }
}

/* The built-in clips, whose plants are known: one label per true plant. */
static void print_generated(double noise_mm, double skate_cm)
{
    static score sum;
    static label labels[MOST_LABELS];
    memset(&sum, 0, sizeof sum);
    for (int i = 0; i < ff_generator_count(); ++i) {
        ff_generator_options options = {.noise_mm = noise_mm, .skate_cm = skate_cm, .seed = 3};
        ff_generated made;
        ff_error error;
        ff_plants plants;
        FF_ASSERT_OK(ff_generator_make(i, &options, &made, &error), error);
        FF_ASSERT_OK(ff_plants_find(&made.clip, &standard()->find, &plants, &error), error);
        int count = 0;
        for (; count < made.plant_count && count < MOST_LABELS; ++count) {
            const ff_true_plant *t = &made.plants[count];
            labels[count] = (label){.foot = t->foot,
                                    .start = t->start,
                                    .end = t->end,
                                    .flat_start = -1,
                                    .flat_end = -1,
                                    .frames = made.clip.frame_count,
                                    .cut_start = t->cut_start,
                                    .cut_end = t->cut_end};
        }
        for (int t = 0; t < 2; ++t)
            score_clip(&plants, labels, count, t, &sum);
        ff_plants_free(&plants);
        ff_generated_free(&made);
    }
    printf("built-in clips, noise %g mm, skate %g cm: F1 %.4f %.4f; start %+d, within 6: %.3f; end %+d, "
           "within 6: "
           "%.3f (%d plants)\n",
           noise_mm, skate_cm, f1(&sum, 0, 0), f1(&sum, 0, 1), edge_median(&sum, 0, EDGE_START),
           edge_within(&sum, 0, EDGE_START, 6), edge_median(&sum, 0, EDGE_END),
           edge_within(&sum, 0, EDGE_END, 6), sum.found[0][0]);
}

int main(void)
{
    const char *shared = ff_shared_folder();
    if (shared)
        print_scores(shared);
    else
        printf("no labelled captures: the outside data is not there\n");
    print_generated(0.0, 0.0);
    print_generated(2.0, 2.0);
    return 0;
}
