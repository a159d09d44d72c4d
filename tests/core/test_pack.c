/* The loader against damage: whatever it accepts can be used, whatever it refuses it refuses with a place. */
#define _GNU_SOURCE
#include "tests/check.h"
#include "tests/core/pack_seal.h"
#include "tests/core/pack_use.h"
#include "tests/core/walker_pack.h"

#include <unistd.h>

typedef struct image {
    unsigned char *data;
    size_t size;
} image;

static int set_up(void **state)
{
    static image good;
    good.data = ff_walker_image(&ff_walker_grid_small, &good.size);
    *state = &good;
    return 0;
}

static int tear_down(void **state)
{
    free(((image *)*state)->data);
    return 0;
}

/* The first size bytes, in a block that ends where they end, so that reading on is noticed. */
static unsigned char *copy_of(const image *from, size_t size)
{
    void *copy = NULL;
    assert_int_equal(posix_memalign(&copy, FF_PACK_ALIGN, size > 0 ? size : 1), 0);
    memcpy(copy, from->data, size);
    return copy;
}

static ff_pack_section *find_section(unsigned char *data, uint32_t tag)
{
    const ff_pack_header *header = (const ff_pack_header *)(const void *)data;
    ff_pack_section *table = (ff_pack_section *)(void *)(data + sizeof *header);
    for (uint32_t i = 0; i < header->section_count; ++i)
        if (table[i].tag == tag) return &table[i];
    fail_msg("section missing");
    return NULL;
}

static void a_good_pack_opens_from_memory_and_from_a_file(void **state)
{
    const image *good = *state;
    ff_error error;
    ff_pack *pack;
    FF_ASSERT_OK(ff_pack_open_memory(good->data, good->size, &pack, &error), error);
    assert_int_equal(ff_pack_joint_count(pack), FF_JOINT_COUNT);
    assert_string_equal(ff_pack_joint_name(pack, 3), "joint3");
    assert_int_equal(ff_pack_joint_parent(pack, 0), -1);
    assert_int_equal(ff_pack_joint_parent(pack, FF_JOINT_COUNT), -1);
    FF_ASSERT_NEAR(ff_pack_joint_offset(pack, 0).y, FF_WALKER_HIPS, 1e-6);
    assert_true(ff_pack_use(pack, 60, 1));
    ff_pack_close(pack);

    char path[] = "/tmp/ff-test-pack-XXXXXX";
    int fd = mkstemp(path);
    assert_true(fd >= 0);
    assert_int_equal(write(fd, good->data, good->size), (ssize_t)good->size);
    close(fd);
    FF_ASSERT_OK(ff_pack_open(path, &pack, &error), error);
    ff_pack_close(pack);
    assert_int_equal(truncate(path, 0), 0);
    assert_int_equal(ff_pack_open(path, &pack, &error), FF_ERR_PARSE);
    assert_string_equal(error.file, path);
    unlink(path);
    assert_int_equal(ff_pack_open(path, &pack, &error), FF_ERR_IO);
    assert_null(pack);
    ff_pack_close(NULL);
}

/* Flip one bit somewhere, half of the time in the records that steer everything else. */
static size_t flip(unsigned char *data, size_t size, ff_random *random)
{
    size_t reach = ff_random_unit(random) < 0.5 ? (size < 6000 ? size : 6000) : size;
    size_t at = (size_t)(ff_random_unit(random) * (double)reach);
    data[at] ^= (unsigned char)(1u << (ff_random_next(random) % 8u));
    return at;
}

static void two_thousand_flips_and_cuts_are_refused_raw_and_harmless_when_sealed(void **state)
{
    const image *good = *state;
    ff_random random = {2026, 1, 0};
    int accepted = 0;
    for (int i = 0; i < 2000; ++i) {
        bool cut = i % 4 == 0;
        size_t size = cut ? (size_t)(ff_random_unit(&random) * (double)good->size) : good->size;
        unsigned char *data = copy_of(good, size);
        if (!cut) flip(data, size, &random);
        ff_pack *pack;
        ff_error error;
        assert_int_not_equal(ff_pack_open_memory(data, size, &pack, &error), FF_OK);
        assert_null(pack);
        assert_true(error.section[0] != 0 && error.message[0] != 0);
        if (cut && size >= sizeof(ff_pack_header)) ((ff_pack_header *)(void *)data)->file_size = size;
        ff_pack_seal(data, size);
        if (ff_pack_open_memory(data, size, &pack, &error) == FF_OK) {
            assert_true(ff_pack_use(pack, 6, (uint64_t)i));
            ff_pack_close(pack);
            ++accepted;
        } else {
            assert_null(pack);
            assert_true(error.section[0] != 0 && error.message[0] != 0);
        }
        free(data);
    }
    assert_in_range(accepted, 100,
                    1900); /* the sealed packs met the checks behind the checksum, and some passed */
}

/* One field of the header or table set to one value each. */
typedef struct bad_field {
    uint32_t tag; /* 0: the header */
    size_t offset;
    uint32_t size;
    uint64_t value;
    ff_status status;
} bad_field;

static const bad_field bad_fields[] = {
    {0, offsetof(ff_pack_header, magic), 8, 1, FF_ERR_PARSE},
    {0, offsetof(ff_pack_header, version), 4, FF_PACK_VERSION + 1, FF_ERR_UNSUPPORTED},
    {0, offsetof(ff_pack_header, file_size), 8, UINT64_MAX, FF_ERR_PARSE},
    {0, offsetof(ff_pack_header, section_count), 4, UINT32_MAX, FF_ERR_PARSE},
    {0, offsetof(ff_pack_header, section_count), 4, 3, FF_ERR_PARSE},
    {FF_SECTION_LANES, offsetof(ff_pack_section, tag), 4, FF_SECTION_KEYS, FF_ERR_PARSE},
    {FF_SECTION_LANES, offsetof(ff_pack_section, tag), 4, FF_TAG('E', 'V', 'I', 'L'), FF_ERR_PARSE},
    {FF_SECTION_JOINTS, offsetof(ff_pack_section, stride), 4, 1, FF_ERR_PARSE},
    {FF_SECTION_JOINTS, offsetof(ff_pack_section, count), 8, UINT64_MAX / 24 + 2, FF_ERR_RANGE},
    {FF_SECTION_JOINTS, offsetof(ff_pack_section, count), 8, 0, FF_ERR_RANGE},
    {FF_SECTION_FEET, offsetof(ff_pack_section, size), 8, UINT64_MAX, FF_ERR_PARSE},
    {FF_SECTION_FEET, offsetof(ff_pack_section, offset), 8, UINT64_MAX - 63, FF_ERR_PARSE},
    {FF_SECTION_FEET, offsetof(ff_pack_section, offset), 8, 0, FF_ERR_PARSE},
    {FF_SECTION_HULL, offsetof(ff_pack_section, offset), 8, 65, FF_ERR_PARSE},
};

static void every_bad_field_of_header_and_table_is_named(void **state)
{
    const image *good = *state;
    for (size_t i = 0; i < sizeof bad_fields / sizeof bad_fields[0]; ++i) {
        const bad_field *bad = &bad_fields[i];
        unsigned char *data = copy_of(good, good->size);
        unsigned char *record = bad->tag ? (unsigned char *)find_section(data, bad->tag) : data;
        memcpy(record + bad->offset, &bad->value, bad->size);
        ff_pack_seal(data, good->size);
        ff_pack *pack;
        ff_error error;
        assert_int_equal(ff_pack_open_memory(data, good->size, &pack, &error), bad->status);
        assert_true(error.section[0] != 0);
        free(data);
    }
}

/* One field of the first (or index-th) record of a section set to a value that must be refused there. */
typedef struct bad_record {
    uint32_t tag, index;
    size_t offset;
    uint32_t word;
} bad_record;

#define NAN_WORD 0x7fc00000u
#define HUGE_WORD 0x7f000000u /* 1.7e38 */
#define MINUS_ONE 0xffffffffu
#define FIRST_LEVEL offsetof(ff_pack_stream, level)
#define CLIP_STREAM 28 /* behind the small grid's 27 walks and its idle example */

static const bad_record bad_records[] = {
    {FF_SECTION_STRINGS, 0, 0, MINUS_ONE},
    {FF_SECTION_JOINTS, 0, offsetof(ff_pack_joint, parent), 0},
    {FF_SECTION_JOINTS, 5, offsetof(ff_pack_joint, parent), 7},
    {FF_SECTION_JOINTS, 2, offsetof(ff_pack_joint, name), 1u << 30},
    {FF_SECTION_JOINTS, 2, offsetof(ff_pack_joint, offset), NAN_WORD},
    {FF_SECTION_JOINTS, 2, offsetof(ff_pack_joint, radius), HUGE_WORD},
    {FF_SECTION_JOINTS, FF_JOINT_KNEE_L, offsetof(ff_pack_joint, offset) + 4, 0},
    {FF_SECTION_POINTS, 1, offsetof(ff_pack_point, joint), FF_JOINT_COUNT},
    {FF_SECTION_POINTS, 1, offsetof(ff_pack_point, joint), MINUS_ONE},
    {FF_SECTION_POINTS, 1, offsetof(ff_pack_point, kind), 0},
    {FF_SECTION_STREAMS, 0, offsetof(ff_pack_stream, first_frame), MINUS_ONE},
    {FF_SECTION_STREAMS, 0, offsetof(ff_pack_stream, frame_count), MINUS_ONE},
    {FF_SECTION_STREAMS, 0, offsetof(ff_pack_stream, frame_count), 0},
    {FF_SECTION_STREAMS, 0, offsetof(ff_pack_stream, rate), NAN_WORD},
    {FF_SECTION_STREAMS, 0, offsetof(ff_pack_stream, flags), 0},
    {FF_SECTION_STREAMS, 0, offsetof(ff_pack_stream, flags), 2},
    {FF_SECTION_STREAMS, 0, offsetof(ff_pack_stream, seconds), NAN_WORD},
    {FF_SECTION_STREAMS, 0, offsetof(ff_pack_stream, seconds), 0},
    {FF_SECTION_STREAMS, 0, offsetof(ff_pack_stream, seconds), HUGE_WORD},
    {FF_SECTION_STREAMS, 0, offsetof(ff_pack_stream, first_lanes), MINUS_ONE},
    {FF_SECTION_STREAMS, 0, offsetof(ff_pack_stream, still), MINUS_ONE},
    {FF_SECTION_STREAMS, 0, FIRST_LEVEL + offsetof(ff_pack_level, first_byte), MINUS_ONE},
    {FF_SECTION_STREAMS, 0, FIRST_LEVEL + offsetof(ff_pack_level, intervals), MINUS_ONE},
    {FF_SECTION_STREAMS, 0, FIRST_LEVEL + offsetof(ff_pack_level, intervals), 0},
    {FF_SECTION_STREAMS, 0, FIRST_LEVEL + offsetof(ff_pack_level, wide), MINUS_ONE},
    {FF_SECTION_STREAMS, CLIP_STREAM, offsetof(ff_pack_stream, first_root), MINUS_ONE},
    {FF_SECTION_STREAMS, CLIP_STREAM, offsetof(ff_pack_stream, root_intervals), MINUS_ONE},
    {FF_SECTION_SLOTS, 0, 0, NAN_WORD},
    {FF_SECTION_SLOTS, 1, offsetof(ff_pack_slots, w), 0},
    {FF_SECTION_LANES, 0, offsetof(ff_pack_lanes, base), NAN_WORD},
    {FF_SECTION_LANES, 0, offsetof(ff_pack_lanes, scale), HUGE_WORD},
    {FF_SECTION_LANES, 0, offsetof(ff_pack_lanes, scale) + 4, NAN_WORD},
    {FF_SECTION_SLOTS, 0, offsetof(ff_pack_slots, lane), 0x00000002u},
    {FF_SECTION_SLOTS, 0, offsetof(ff_pack_slots, lane), MINUS_ONE},
    {FF_SECTION_SLOTS, 0, offsetof(ff_pack_slots, lane) + 72, 0x01010108u}, /* a moving w, not flagged */
    {FF_SECTION_KEYS, 0, 0, 0x12345678u}, /* the first key of a cycle, but not the one that closes it */
    {FF_SECTION_ROOTS, 0, 0, NAN_WORD},
    {FF_SECTION_ROOTS, 1, 8, HUGE_WORD},
    {FF_SECTION_CLIPS, 0, offsetof(ff_pack_clip, tags), 1u << 30},
    {FF_SECTION_CLIPS, 0, offsetof(ff_pack_clip, stream), 1000},
    {FF_SECTION_CLIPS, 0, offsetof(ff_pack_clip, first_plant), MINUS_ONE},
    {FF_SECTION_CLIPS, 0, offsetof(ff_pack_clip, action_count), 2},
    {FF_SECTION_CLIPS, 0, offsetof(ff_pack_clip, source_rate), 0},
    {FF_SECTION_PLANTS, 0, offsetof(ff_pack_plant, clip), 1},
    {FF_SECTION_PLANTS, 0, offsetof(ff_pack_plant, foot), 2},
    {FF_SECTION_PLANTS, 0, offsetof(ff_pack_plant, start), HUGE_WORD},
    {FF_SECTION_PLANTS, 0, offsetof(ff_pack_plant, confidence), NAN_WORD},
    {FF_SECTION_ACTIONS, 0, offsetof(ff_pack_action, clip), 1},
    {FF_SECTION_ACTIONS, 0, offsetof(ff_pack_action, mode), FF_MODE_COUNT},
    {FF_SECTION_ACTIONS, 0, offsetof(ff_pack_action, coarse_radius), NAN_WORD},
    {FF_SECTION_ACTIONS, 0, offsetof(ff_pack_action, first_collider), 1},
    {FF_SECTION_ACTIONS, 0, offsetof(ff_pack_action, collider_samples), 0x55555556u},
    {FF_SECTION_ACTIONS, 0, offsetof(ff_pack_action, support_plant), 1},
    {FF_SECTION_ACTIONS, 0, offsetof(ff_pack_action, reach), 1},
    {FF_SECTION_COLLIDERS, 1, offsetof(ff_pack_collider, y), NAN_WORD},
    {FF_SECTION_COLLIDER_RADII, 0, 0, NAN_WORD},
    {FF_SECTION_COLLIDER_RADII, 0, 20, 0},
    {FF_SECTION_COLLIDER_RADII, 0, 4, HUGE_WORD},
    {FF_SECTION_EXAMPLES, 0, offsetof(ff_pack_example, name), 1u << 30},
    {FF_SECTION_EXAMPLES, 1, offsetof(ff_pack_example, stream), 0},
    {FF_SECTION_EXAMPLES, 1, offsetof(ff_pack_example, stream), MINUS_ONE},
    {FF_SECTION_EXAMPLES, 1, offsetof(ff_pack_example, clip), 7},
    {FF_SECTION_EXAMPLES, 1, offsetof(ff_pack_example, gait), FF_GAIT_COUNT},
    {FF_SECTION_EXAMPLES, 1, offsetof(ff_pack_example, flags), MINUS_ONE},
    {FF_SECTION_EXAMPLES, 1, offsetof(ff_pack_example, period), NAN_WORD},
    {FF_SECTION_EXAMPLES, 1, offsetof(ff_pack_example, turn_rate), NAN_WORD},
    {FF_SECTION_EXAMPLES, 1, offsetof(ff_pack_example, key) + 4, 0},
    {FF_SECTION_EXAMPLES, 1, offsetof(ff_pack_example, key) + 12, NAN_WORD},
    {FF_SECTION_EXAMPLES, 1, offsetof(ff_pack_example, lock), HUGE_WORD},
    {FF_SECTION_FEET, 2, offsetof(ff_pack_foot, pitch), NAN_WORD},
    {FF_SECTION_SIMPLICES, 0, offsetof(ff_pack_simplex, vertex), MINUS_ONE},
    {FF_SECTION_SIMPLICES, 0, offsetof(ff_pack_simplex, vertex) + 4, 1000},
    {FF_SECTION_SIMPLICES, 0, offsetof(ff_pack_simplex, gait), FF_GAIT_COUNT},
    {FF_SECTION_SIMPLICES, 0, offsetof(ff_pack_simplex, gait), FF_GAIT_RUN},
    {FF_SECTION_HULL, 1, 0, NAN_WORD},
    {FF_SECTION_HULL, 1, 0, 0xc1000000u},
    {FF_SECTION_LOOPS, 0, offsetof(ff_pack_loop, cut), NAN_WORD},
    {FF_SECTION_LOOPS, 1, offsetof(ff_pack_loop, moved), HUGE_WORD},
    {FF_SECTION_CORRESPONDENCES, 0, offsetof(ff_pack_correspondence, from), 1000},
    {FF_SECTION_CORRESPONDENCES, 0, offsetof(ff_pack_correspondence, to), 0},
    {FF_SECTION_CORRESPONDENCES, 1, offsetof(ff_pack_correspondence, to), 1},
    {FF_SECTION_CORRESPONDENCES, 1, offsetof(ff_pack_correspondence, first_pair), 1},
    {FF_SECTION_CORRESPONDENCES, 1, offsetof(ff_pack_correspondence, pair_count), 2},
    {FF_SECTION_CORRESPONDENCES, 1, offsetof(ff_pack_correspondence, pair_count), 0},
    {FF_SECTION_CORRESPONDENCES, 0, offsetof(ff_pack_correspondence, flags), MINUS_ONE},
    {FF_SECTION_CORRESPONDENCES, 0, offsetof(ff_pack_correspondence, wait), NAN_WORD},
    {FF_SECTION_PAIRS, 0, offsetof(ff_pack_pair, phase), 0x3f800000u},
    {FF_SECTION_PAIRS, 0, offsetof(ff_pack_pair, phase), 0x3f400000u},
    {FF_SECTION_PAIRS, 1, offsetof(ff_pack_pair, phase) + 4, NAN_WORD},
    {FF_SECTION_PAIRS, 1, offsetof(ff_pack_pair, turn), NAN_WORD},
    {FF_SECTION_GAIT, 0, offsetof(ff_pack_gait, example), 1000},
    {FF_SECTION_GAIT, 0, offsetof(ff_pack_gait, speed), 0},
    {FF_SECTION_GAIT, 0, offsetof(ff_pack_gait, period), NAN_WORD},
    {FF_SECTION_GAIT, 0, offsetof(ff_pack_gait, stance), 0},
    {FF_SECTION_GAIT, 0, offsetof(ff_pack_gait, law), NAN_WORD},
    {FF_SECTION_GAIT_PATH, 3, offsetof(ff_pack_gait_path, pitch), NAN_WORD},
    {FF_SECTION_SHARP, 0, offsetof(ff_pack_sharp, side), 0},
    {FF_SECTION_SHARP, 1, offsetof(ff_pack_sharp, direction), 0},
    {FF_SECTION_SKINS, 0, offsetof(ff_pack_skin, first_vertex), 4},
    {FF_SECTION_SKINS, 1, offsetof(ff_pack_skin, vertex_count), MINUS_ONE},
    {FF_SECTION_SKINS, 1, offsetof(ff_pack_skin, vertex_count), 2},
    {FF_SECTION_SKINS, 0, offsetof(ff_pack_skin, first_triangle), 2},
    {FF_SECTION_SKINS, 0, offsetof(ff_pack_skin, triangle_count), 0},
    {FF_SECTION_VERTICES, 0, offsetof(ff_pack_vertex, position), HUGE_WORD},
    {FF_SECTION_VERTICES, 6, offsetof(ff_pack_vertex, normal), NAN_WORD},
    {FF_SECTION_VERTICES, 6, offsetof(ff_pack_vertex, uv), NAN_WORD},
    {FF_SECTION_VERTICES, 1, offsetof(ff_pack_vertex, joints), 200},
    {FF_SECTION_VERTICES, 1, offsetof(ff_pack_vertex, weights), 0x0101},
    {FF_SECTION_TRIANGLES, 1, offsetof(ff_pack_triangle, corner) + 4, 4},
    {FF_SECTION_TRIANGLES, 2, offsetof(ff_pack_triangle, corner), 3},
};

static void every_bad_record_is_refused_in_its_own_section(void **state)
{
    const image *good = *state;
    for (size_t i = 0; i < sizeof bad_records / sizeof bad_records[0]; ++i) {
        const bad_record *bad = &bad_records[i];
        unsigned char *data = copy_of(good, good->size);
        const ff_pack_section *section = find_section(data, bad->tag);
        memcpy(data + section->offset + (uint64_t)section->stride * bad->index + bad->offset, &bad->word,
               section->stride < 4 ? section->stride : 4);
        ff_pack_seal(data, good->size);
        ff_pack *pack = NULL;
        ff_error error;
        if (ff_pack_open_memory(data, good->size, &pack, &error) == FF_OK) {
            print_error("bad record %zu was accepted\n", i);
            fail();
        }
        free(data);
    }
}

static void packs_without_walks_or_in_odd_memory_are_refused(void **state)
{
    const image *good = *state;
    ff_error error;
    ff_pack *pack;
    assert_int_equal(ff_pack_open_memory(NULL, 0, &pack, &error), FF_ERR_ARGUMENT);
    assert_int_equal(ff_pack_open_memory(good->data + 1, good->size - 1, &pack, &error), FF_ERR_ARGUMENT);
    unsigned char *data = copy_of(good, good->size);
    const ff_pack_section *section = find_section(data, FF_SECTION_EXAMPLES);
    ff_pack_example *example = (ff_pack_example *)(void *)(data + section->offset);
    for (uint64_t i = 0; i < section->count; ++i)
        example[i].flags |= FF_EXAMPLE_IDLE;
    ff_pack_seal(data, good->size);
    FF_ASSERT_OK(ff_pack_open_memory(data, good->size, &pack, &error), error);
    ff_blend_space *space;
    assert_int_equal(ff_blend_space_create(pack, &space, &error), FF_ERR_NO_DATA);
    assert_null(space);
    ff_pack_close(pack);
    free(data);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_good_pack_opens_from_memory_and_from_a_file),
        cmocka_unit_test(two_thousand_flips_and_cuts_are_refused_raw_and_harmless_when_sealed),
        cmocka_unit_test(every_bad_field_of_header_and_table_is_named),
        cmocka_unit_test(every_bad_record_is_refused_in_its_own_section),
        cmocka_unit_test(packs_without_walks_or_in_odd_memory_are_refused),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
