/* Pictures: PNG files of sane size with something on them, drawn where they should be. */
#define _XOPEN_SOURCE 700 /* mkdtemp */

#include "runtime/export/film.h"
#include "runtime/export/gait_window.h"
#include "runtime/export/raster.h"
#include "runtime/export/trajectories.h"
#include "tests/export/folder.h"
#include "tests/export/walker.h"

static uint32_t big_endian(const char *data)
{
    const unsigned char *b = (const unsigned char *)data;
    return (uint32_t)b[0] << 24 | (uint32_t)b[1] << 16 | (uint32_t)b[2] << 8 | b[3];
}

static void check_png(const char *name, uint32_t *width, uint32_t *height)
{
    ff_file file = folder_read(name);
    assert_true(file.size > 10000);
    assert_memory_equal(file.data, "\x89PNG\r\n\x1a\n", 8);
    *width = big_endian(file.data + 16);
    *height = big_endian(file.data + 20);
    ff_file_unmap(&file);
}

static void test_film_and_trajectories_are_written_for_a_walk(void **state)
{
    (void)state;
    ff_error error;
    ff_figure figure;
    ff_scene scene;
    ff_recording recording;
    uint32_t width, height;
    walker_figure(&figure);
    walker_scene("{\"kind\": \"circle\", \"agents\": 3, \"walls\": [[-2, 0, 2, 0]]}", &scene);
    walker_record(&scene, 4.0, &recording);
    FF_ASSERT_OK(ff_film_write(folder_path("film.png"), &figure, &scene, &recording, &error), error);
    check_png("film.png", &width, &height);
    assert_int_equal(width, 2000);
    assert_true(height > 1500 && height < 2500);
    FF_ASSERT_OK(ff_trajectories_write(folder_path("trajectories.png"), &scene, &recording, &error), error);
    check_png("trajectories.png", &width, &height);
    assert_true(width > 1000 && height > 1000 && width < 2000 && height < 2000);
    ff_recording_free(&recording);
    ff_scene_free(&scene);
}

static void test_a_run_too_short_to_show_a_step_still_makes_a_film(void **state)
{
    (void)state;
    ff_error error;
    ff_figure figure;
    ff_scene scene;
    ff_recording recording;
    uint32_t width, height;
    walker_figure(&figure);
    walker_scene("{\"kind\": \"custom\", \"agents\": [{\"position\": [0, 0], \"goal\": [0, 0]}]}", &scene);
    walker_record(&scene, 0.0, &recording);
    FF_ASSERT_OK(ff_film_write(folder_path("film.png"), &figure, &scene, &recording, &error), error);
    FF_ASSERT_OK(ff_trajectories_write(folder_path("trajectories.png"), &scene, &recording, &error), error);
    check_png("film.png", &width, &height);
    ff_recording_free(&recording);
    ff_scene_free(&scene);
}

static void test_the_film_shows_two_whole_cycles_at_full_speed(void **state)
{
    (void)state;
    ff_scene scene;
    ff_recording recording;
    walker_scene("{\"kind\": \"circle\", \"agents\": 1}", &scene);
    walker_record(&scene, 9.0, &recording); /* walks 6.15 s, then stands */
    ff_gait_window window = ff_gait_window_find(&recording, 0);
    assert_true(window.cycles);
    FF_ASSERT_NEAR((window.last - window.first) * scene.step, 2.0 * 1.4 / 1.3, 0.07);
    FF_ASSERT_BELOW(window.last * scene.step, 6.2);
    ff_recording_free(&recording);
    ff_scene_free(&scene);
}

static void test_a_camera_puts_what_it_looks_at_into_the_middle(void **state)
{
    (void)state;
    ff_camera camera = ff_camera_look(ff_v3(0, 2, -8), ff_v3(0, 1, 0), ff_v3(0, 1, 0), true);
    camera.scale = 800.0;
    camera.centre_x = 400.0;
    camera.centre_y = 300.0;
    double depth;
    ff_pixel middle = ff_camera_project(&camera, ff_v3(0, 1, 0), &depth);
    FF_ASSERT_NEAR(middle.x, 400.0, 1e-9);
    FF_ASSERT_NEAR(middle.y, 300.0, 1e-9);
    FF_ASSERT_NEAR(depth, sqrt(65.0), 1e-12);
    ff_pixel above = ff_camera_project(&camera, ff_v3(0, 1.5, 0), NULL);
    assert_true(above.y < 300.0);
    /* Looking along +z, the left of the world (+x) is on the left. */
    ff_pixel left = ff_camera_project(&camera, ff_v3(1, 1, 0), NULL);
    FF_ASSERT_NEAR(left.x, 400.0 - 800.0 / sqrt(65.0), 1e-9);
}

static void test_the_nearer_triangle_hides_the_farther_whatever_the_order(void **state)
{
    (void)state;
    ff_error error;
    ff_raster raster;
    FF_ASSERT_OK(ff_raster_create(40, 40, &raster, &error), error);
    ff_camera camera = ff_camera_look(ff_v3(0, 0, 5), ff_v3(0, 0, 0), ff_v3(0, 1, 0), false);
    camera.scale = 10.0;
    camera.centre_x = camera.centre_y = 20.0;
    ff_shaded_vertex quad[2][3];
    for (int k = 0; k < 2; ++k) { /* k = 1 is nearer and red */
        static const double corner[3][2] = {{-1, -1}, {1, -1}, {0, 1}};
        for (int c = 0; c < 3; ++c)
            quad[k][c] = (ff_shaded_vertex){
                ff_v3(corner[c][0], corner[c][1], k), ff_v3(0, 0, 1), {k ? 200 : 0, k ? 0 : 200, 0}};
    }
    static const uint32_t triangle[1][3] = {{0, 1, 2}};
    for (int order = 0; order < 2; ++order) {
        ff_raster_clear(&raster, (ff_colour){0, 0, 0}, (ff_colour){0, 0, 0});
        ff_raster_mesh(&raster, &camera, quad[order], triangle, 1);
        ff_raster_mesh(&raster, &camera, quad[1 - order], triangle, 1);
        const uint8_t *pixel = raster.rgb + 3 * (20 * 40 + 20);
        assert_true(pixel[0] > 100 && pixel[1] < 60);
    }
    ff_raster_destroy(&raster);
}

static void test_an_absurd_picture_is_refused(void **state)
{
    (void)state;
    ff_error error;
    ff_picture *picture = NULL;
    assert_int_equal(ff_picture_create(0, 10, (ff_colour){0, 0, 0}, &picture, &error), FF_ERR_RANGE);
    assert_int_equal(ff_picture_create(1000000, 10, (ff_colour){0, 0, 0}, &picture, &error), FF_ERR_RANGE);
    assert_null(picture);
}

static int remove_folder(void **state)
{
    (void)state;
    static const char *const names[] = {"film.png", "trajectories.png", NULL};
    return folder_remove(names);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_film_and_trajectories_are_written_for_a_walk),
        cmocka_unit_test(test_a_run_too_short_to_show_a_step_still_makes_a_film),
        cmocka_unit_test(test_the_film_shows_two_whole_cycles_at_full_speed),
        cmocka_unit_test(test_a_camera_puts_what_it_looks_at_into_the_middle),
        cmocka_unit_test(test_the_nearer_triangle_hides_the_farther_whatever_the_order),
        cmocka_unit_test(test_an_absurd_picture_is_refused),
    };
    return cmocka_run_group_tests(tests, folder_create, remove_folder);
}
