/* The plant detector against hand-checked labels of captured clips. */
#include "tests/preprocess/plant_score.h"

static void agrees_with_the_labels(void **state)
{
    (void)state;
    const char *shared = ff_shared_folder();
    if (!shared) {
        print_message("SKIPPED agrees_with_the_labels: the shared folder with labelled clips is not there\n");
        skip();
    }
    static score sum;
    score_all(shared, NULL, &sum);
    print_message("F1 at IoU 0.5 and 0.8: walking %.4f %.4f, running %.4f %.4f\n", f1(&sum, 0, 0),
                  f1(&sum, 0, 1), f1(&sum, 1, 0), f1(&sum, 1, 1));
    assert_true(f1(&sum, 0, 0) >= 0.995);
    assert_true(f1(&sum, 0, 1) >= 0.98);
    assert_true(f1(&sum, 1, 0) >= 0.98);
    assert_true(f1(&sum, 1, 1) >= 0.93);
    static const double most[2] = {0.95, 0.90};
    for (int kind = 0; kind < 2; ++kind) {
        for (int edge = EDGE_START; edge <= EDGE_END; ++edge) {
            assert_in_range(edge_median(&sum, kind, edge) + 3, 0, 6);
            assert_true(edge_within(&sum, kind, edge, 6) >= most[kind]);
        }
        for (int edge = EDGE_FLAT_START; edge <= EDGE_FLAT_END; ++edge)
            assert_true(edge_within(&sum, kind, edge, 10) >= 0.9);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(agrees_with_the_labels),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
