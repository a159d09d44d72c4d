/* The report of a whole pack: complete, self-contained, well-formed. */
#define _GNU_SOURCE
#include "preprocess/report/report.h"

#include "preprocess/report/report_parts.h"
#include "runtime/core/base/file.h"
#include "tests/built_in_pack.h"

#include <stdio.h>
#include <unistd.h>

typedef struct page {
    ff_pack *pack;
    char *text; /* the HTML, without what pictures hold */
    size_t length, bytes;
    uint32_t pictures; /* PNG in base64 */
} page;

/* Letters of a picture may be any: take them out, once looked at. */
static void cut_pictures(page *p)
{
    static const char head[] = "data:image/png;base64,iVBORw0KGgo"; /* as every PNG begins */
    char *to = p->text;
    for (const char *from = p->text; *from;) {
        if (strncmp(from, head, sizeof head - 1) == 0) {
            size_t size =
                strspn(from + sizeof head - 1, "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz"
                                               "0123456789+/=");
            from += sizeof head - 1 + size;
            assert_int_equal(*from, '"');
            ++p->pictures;
        } else {
            *to++ = *from++;
        }
    }
    *to = 0;
    p->length = (size_t)(to - p->text);
}

static page shared; /* made once for all tests */

static int page_make(void **state)
{
    (void)state;
    page p;
    ff_error error;
    FF_ASSERT_OK(ff_pack_open(ff_built_in_pack_path(), &p.pack, &error), error);
    char folder[] = "/tmp/ff-report-XXXXXX", path[64];
    assert_non_null(mkdtemp(folder));
    FF_ASSERT_OK(ff_report_write(p.pack, "a & b <built-in>", folder, &error), error);
    snprintf(path, sizeof path, "%s/index.html", folder);
    ff_file file;
    FF_ASSERT_OK(ff_file_map(path, &file, &error), error);
    p.text = calloc(1, file.size + 1);
    assert_non_null(p.text);
    memcpy(p.text, file.data, file.size);
    p.bytes = p.length = file.size;
    p.pictures = 0;
    cut_pictures(&p);
    ff_file_unmap(&file);
    unlink(path);
    rmdir(folder);
    shared = p;
    return 0;
}

static int page_free(void **state)
{
    (void)state;
    ff_pack_close(shared.pack);
    free(shared.text);
    return 0;
}

static uint32_t count(const page *p, const char *what)
{
    uint32_t n = 0;
    const char *end = p->text + p->length;
    for (const char *at = p->text; (at = memmem(at, (size_t)(end - at), what, strlen(what)));
         at += strlen(what))
        ++n;
    return n;
}

static uint32_t unmirrored(const ff_pack *pack)
{
    uint32_t n = 0;
    for (uint32_t i = 0; i < pack->action_count; ++i)
        n += !(pack->actions[i].flags & FF_ACTION_MIRRORED);
    return n;
}

static void shows_every_clip_plant_action_and_example(void **state)
{
    (void)state;
    page p = shared;
    assert_int_equal(count(&p, "<h2 id=\"clip-"), p.pack->clip_count);
    assert_int_equal(count(&p, "class=\"plant\""), p.pack->plant_count);
    assert_int_equal(count(&p, "class=\"card\""), unmirrored(p.pack));
    assert_int_equal(count(&p, "class=\"hull\""), 1);
    assert_true(count(&p, "<tr><td>") >= p.pack->example_count);
    assert_true(count(&p, "class=\"rejected\"") >= p.pack->clip_count); /* at least what the ends cut */
    assert_int_equal(count(&p, "class=\"rejected\""), count(&p, "<li>"));
}

static void shows_how_examples_move_close_and_correspond(void **state)
{
    (void)state;
    page p = shared;
    uint32_t own = 0;
    for (uint32_t i = 0; i < p.pack->example_count; ++i)
        own += !(p.pack->examples[i].flags & FF_EXAMPLE_MIRRORED);
    assert_int_equal(count(&p, "class=\"card example\""), own);
    assert_int_equal(count(&p, "class=\"kind\""), 19);
    assert_int_equal(count(&p, ">missing<"), 0);
    assert_int_equal(count(&p, "class=\"map\""), p.pack->correspondence_count);
    assert_int_equal(p.pictures, p.pack->correspondence_count);
    FF_ASSERT_BELOW((double)p.bytes, 15e6);
    assert_int_equal(count(&p, "<h2>Semi-procedural clip</h2>"), 1);
}

static void is_well_formed_and_needs_no_other_file(void **state)
{
    (void)state;
    static const char *const forbidden[] = {
        "nan", "inf\"", "http:", "https:", "src=", "url(", "<script", "b <built-in>"};
    static const char *const paired[][2] = {{"<svg", "</svg>"},         {"<div", "</div>"},
                                            {"<details", "</details>"}, {"<g ", "</g>"},
                                            {"<table", "</table>"},     {"<title>", "</title>"}};
    page p = shared;
    for (size_t i = 0; i < sizeof forbidden / sizeof *forbidden; ++i)
        if (count(&p, forbidden[i]) > 0) {
            print_error("the page holds '%s'\n", forbidden[i]);
            fail();
        }
    for (size_t i = 0; i < sizeof paired / sizeof *paired; ++i)
        assert_int_equal(count(&p, paired[i][0]), count(&p, paired[i][1]));
    assert_int_equal(count(&p, "a &amp; b &lt;built-in&gt;"), 2);
    assert_string_equal(p.text + p.length - 8, "</html>\n");
}

static void poses_are_those_of_people(void **state)
{
    (void)state;
    page p = shared;
    ff_vec3 at[FF_PACK_MAX_JOINTS + FF_POINT_COUNT];
    for (uint32_t c = 0; c < p.pack->clip_count; c += 5) {
        const ff_pack_clip *clip = &p.pack->clips[c];
        ff_report_pose(p.pack, clip->stream, 0.5, at);
        const ff_vec3 *point = at + p.pack->joint_count;
        assert_true(point[FF_POINT_HEAD_TOP].y > 1.0 && point[FF_POINT_HEAD_TOP].y < 2.2);
        FF_ASSERT_BELOW(ff_min(point[FF_POINT_TOE_L].y, point[FF_POINT_TOE_R].y), 0.4);
    }
}

static void long_names_are_cut_and_escaped(void **state)
{
    (void)state;
    char name[2000];
    memset(name, '&', sizeof name - 1);
    name[sizeof name - 1] = 0;
    ff_text text = {.failed = false};
    ff_report_text(&text, name);
    assert_false(text.failed);
    assert_true(text.bytes.count > 400 && text.bytes.count <= 500);
    assert_memory_equal(text.bytes.data, "&amp;&amp;", 10);
    assert_memory_equal((char *)text.bytes.data + text.bytes.count - 5, "&amp;", 5);
    ff_text_free(&text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shows_every_clip_plant_action_and_example),
        cmocka_unit_test(shows_how_examples_move_close_and_correspond),
        cmocka_unit_test(is_well_formed_and_needs_no_other_file),
        cmocka_unit_test(poses_are_those_of_people),
        cmocka_unit_test(long_names_are_cut_and_escaped),
    };
    return cmocka_run_group_tests(tests, page_make, page_free);
}
