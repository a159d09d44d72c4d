/* A crowd saved, loaded and continued does what it would have done; whatever is damaged is refused. */
#define _POSIX_C_SOURCE 200809L
#include "tests/core/crowd_saved.h"
#include "tests/core/crowd_trial.h"
#include "tests/core/pack_seal.h"

#include "runtime/core/crowd/crowd_format.h"

#include <stdio.h>
#include <unistd.h>

static ff_pack *pack, *other_pack;
static void *image, *other_image;

static int open_packs(void **state)
{
    (void)state;
    size_t size;
    ff_error error;
    image = ff_walker_image(&ff_walker_grid_full, &size);
    FF_ASSERT_OK(ff_pack_open_memory(image, size, &pack, &error), error);
    other_image = ff_walker_image(&ff_walker_grid_small, &size);
    FF_ASSERT_OK(ff_pack_open_memory(other_image, size, &other_pack, &error), error);
    return 0;
}

static int close_packs(void **state)
{
    (void)state;
    ff_pack_close(pack);
    ff_pack_close(other_pack);
    free(image);
    free(other_image);
    return 0;
}

static ff_crowd *reload(ff_crowd *crowd, uint32_t threads)
{
    ff_error error;
    size_t size;
    unsigned char *data = ff_saved_bytes(crowd, &size);
    ff_crowd_destroy(crowd);
    ff_crowd_def run = ff_crowd_def_default();
    run.threads = threads;
    ff_crowd *loaded;
    FF_ASSERT_OK(ff_crowd_load(pack, data, size, &run, &loaded, &error), error);
    free(data);
    return loaded;
}

/* People come and go in a scene with walls; where `stop` says so the crowd is saved, thrown away and loaded. */
static uint64_t busy(uint32_t steps, uint32_t stop, uint32_t threads)
{
    ff_error error;
    ff_crowd *crowd;
    ff_crowd_def def = ff_crowd_def_default();
    def.max_agents = 40;
    def.mcn.back_pedal = true;
    def.baseline.padding = 0.03;
    FF_ASSERT_OK(ff_crowd_create(pack, &def, &crowd, &error), error);
    trial_wall(crowd, ff_v2(-3, 1), ff_v2(3, 1.5));
    trial_wall(crowd, ff_v2(3, 1.5), ff_v2(3, 4));
    ff_random random = {5, 1, 0};
    ff_agent agents[40];
    for (uint32_t i = 0; i < 40; ++i) {
        ff_agent_def agent = ff_agent_def_default();
        agent.position = ff_scale2(ff_fwd2(FF_TAU * i / 40.0), 7.0);
        agent.goal = ff_scale2(agent.position, -1.0);
        agent.navigation = i % 8 == 0 ? FF_NAVIGATION_ORCA : FF_NAVIGATION_CROWD;
        FF_ASSERT_OK(ff_crowd_add_agent(crowd, &agent, &agents[i], &error), error);
    }
    for (uint32_t step = 0; step < steps; ++step) {
        if (stop && step % stop == stop - 1) crowd = reload(crowd, threads);
        ff_crowd_step(crowd);
        if (step % 40 != 39) continue;
        uint32_t k = (uint32_t)(ff_random_next(&random) % 40);
        ff_agent_def agent = ff_agent_def_default();
        agent.position = ff_scale2(ff_fwd2(ff_random_range(&random, -3, 3)), 9.0);
        agent.goal = ff_scale2(agent.position, -0.8);
        FF_ASSERT_OK(ff_crowd_remove_agent(crowd, agents[k], &error), error);
        if (step % 120 == 39) FF_ASSERT_OK(ff_crowd_remove_agent(crowd, agents[(k + 9) % 40], &error), error);
        FF_ASSERT_OK(ff_crowd_add_agent(crowd, &agent, &agents[k], &error), error);
        if (step % 120 == 39)
            FF_ASSERT_OK(ff_crowd_add_agent(crowd, &agent, &agents[(k + 9) % 40], &error), error);
    }
    uint64_t hash = ff_crowd_state_hash(crowd);
    ff_crowd_destroy(crowd);
    return hash;
}

static void saved_loaded_and_continued_equals_never_stopped_to_the_bit(void **state)
{
    (void)state;
    uint64_t never = busy(1200, 0, 1);
    assert_true(never == busy(1200, 600, 1));
    assert_true(never == busy(1200, 37, 1));
    assert_true(never == busy(1200, 101, 2));
    assert_true(never != busy(1199, 0, 1));
}

static void the_same_crowd_gives_the_same_bytes_and_a_loaded_one_gives_them_again(void **state)
{
    (void)state;
    ff_error error;
    size_t size, again;
    ff_crowd *crowd = ff_saved_crowd(pack), *twin = ff_saved_crowd(pack), *loaded;
    unsigned char *data = ff_saved_bytes(crowd, &size), *same = ff_saved_bytes(twin, &again);
    assert_int_equal(size, again);
    assert_memory_equal(data, same, size);
    free(same);
    FF_ASSERT_OK(ff_crowd_load(pack, data, size, NULL, &loaded, &error), error);
    assert_true(ff_crowd_state_hash(loaded) == ff_crowd_state_hash(crowd));
    assert_int_equal(ff_crowd_step_count(loaded), 45);
    uint32_t living = ff_crowd_agent_count(crowd);
    assert_in_range(living, 8, 12);
    assert_int_equal(ff_crowd_agent_count(loaded), living);
    assert_int_equal(ff_crowd_signal_phase(loaded, 0), 1);
    ff_crowd_counts counts = ff_crowd_count(loaded), were = ff_crowd_count(crowd);
    assert_memory_equal(&counts, &were, sizeof counts);
    same = ff_saved_bytes(loaded, &again);
    assert_int_equal(size, again);
    assert_memory_equal(data, same, size);
    ff_agent before[12], after[12];
    assert_int_equal(ff_crowd_agents(crowd, before, 12), ff_crowd_agents(loaded, after, 12));
    assert_memory_equal(before, after, living * sizeof *before);
    assert_int_equal(ff_crowd_save(crowd, data, size - 1, &error), FF_ERR_ARGUMENT);
    free(same);
    free(data);
    ff_crowd_destroy(loaded);
    ff_crowd_destroy(twin);
    ff_crowd_destroy(crowd);
}

static void a_crowd_goes_through_a_file_and_only_with_its_own_pack(void **state)
{
    (void)state;
    ff_error error;
    char path[] = "/tmp/footfall-crowd-XXXXXX";
    int file = mkstemp(path);
    assert_true(file >= 0);
    close(file);
    ff_crowd *crowd = ff_saved_crowd(pack), *loaded;
    FF_ASSERT_OK(ff_crowd_save_file(crowd, path, &error), error);
    FF_ASSERT_OK(ff_crowd_load_file(pack, path, NULL, &loaded, &error), error);
    assert_true(ff_crowd_state_hash(loaded) == ff_crowd_state_hash(crowd));
    ff_crowd_destroy(loaded);
    assert_int_equal(ff_crowd_load_file(other_pack, path, NULL, &loaded, &error), FF_ERR_ARGUMENT);
    assert_null(loaded);
    assert_string_equal(error.section, "HEAD");
    assert_string_equal(error.file, path);
    assert_non_null(strstr(error.message, "another motion pack"));
    assert_int_equal(remove(path), 0);
    assert_int_equal(ff_crowd_load_file(pack, path, NULL, &loaded, &error), FF_ERR_IO);
    assert_int_equal(ff_crowd_save_file(crowd, "/nowhere/at/all", &error), FF_ERR_IO);
    assert_int_equal(ff_crowd_load_file(pack, NULL, NULL, &loaded, &error), FF_ERR_ARGUMENT);
    assert_int_equal(ff_crowd_load(NULL, path, 1, NULL, &loaded, &error), FF_ERR_ARGUMENT);
    ff_crowd_destroy(crowd);
}

static void five_hundred_flips_and_cuts_are_refused_raw_and_harmless_when_sealed(void **state)
{
    (void)state;
    ff_crowd *crowd = ff_saved_crowd(pack), *loaded;
    size_t whole;
    unsigned char *good = ff_saved_bytes(crowd, &whole);
    ff_crowd_destroy(crowd);
    ff_random random = {2027, 1, 0};
    int accepted = 0;
    for (int i = 0; i < 500; ++i) {
        bool cut = i % 4 == 0;
        size_t size = cut ? (size_t)(ff_random_unit(&random) * (double)whole) : whole;
        unsigned char *data = malloc(size + 1);
        assert_non_null(data);
        memcpy(data, good, size);
        size_t at = (size_t)(ff_random_unit(&random) * (double)size);
        if (!cut) data[at] ^= (unsigned char)(1u << (ff_random_next(&random) & 7u));
        ff_error error;
        assert_int_not_equal(ff_crowd_load(pack, data, size, NULL, &loaded, &error), FF_OK);
        assert_null(loaded);
        assert_true(error.section[0] != 0 && error.message[0] != 0);
        if (cut && size >= sizeof(ff_pack_header)) memcpy(data + 16, &size, sizeof size);
        ff_pack_seal(data, size);
        if (ff_crowd_load(pack, data, size, NULL, &loaded, &error) == FF_OK) {
            assert_true(ff_saved_use(loaded, 3));
            ff_crowd_destroy(loaded);
            ++accepted;
        } else {
            assert_true(error.section[0] != 0 && error.message[0] != 0);
        }
        free(data);
    }
    assert_in_range(accepted, 25, 475);
    free(good);
}

/* ---------------------------------------------------------------------------------------- bad values */

static ff_pack_section *find_section(unsigned char *data, const char *name)
{
    ff_pack_header header;
    memcpy(&header, data, sizeof header);
    for (uint32_t i = 0; i < header.section_count; ++i) {
        ff_pack_section *section = (ff_pack_section *)(void *)(data + sizeof header) + i;
        if (memcmp(&section->tag, name, 4) == 0) return section;
    }
    fail();
    return NULL;
}

/* A member of a record set to a value that must be refused there; reals are given by their bits. */
typedef struct bad_value {
    const char *section;
    uint32_t index;
    size_t offset, size;
    uint64_t value;
} bad_value;

#define NOT_A_NUMBER 0x7ff8000000000000u
#define HUGE 0x7fe0000000000000u /* 9e307 */
#define BELOW_0 0xbff0000000000000u
#define REAL(type, member, bits) offsetof(type, member), 8, bits
#define WORD(type, member, value) offsetof(type, member), 4, value

static const bad_value bad_values[] = {
    {"HEAD", 0, REAL(ff_saved_head, pack_checksum, 1)},
    {"HEAD", 0, REAL(ff_saved_head, pack_size, 1)},
    {"HEAD", 0, WORD(ff_saved_head, agent_count, 11)},
    {"HEAD", 0, WORD(ff_saved_head, slot_count, 13)},
    {"CDEF", 0, REAL(ff_saved_def, step, NOT_A_NUMBER)},
    {"CDEF", 0, REAL(ff_saved_def, keep_right, HUGE)},
    {"CDEF", 0, WORD(ff_saved_def, max_agents, 0)},
    {"CDEF", 0, WORD(ff_saved_def, max_agents, UINT32_MAX)},
    {"CDEF", 0, WORD(ff_saved_def, navigation, FF_NAVIGATION_SF + 1)},
    {"CDEF", 0, WORD(ff_saved_def, facing, 4)},
    {"CDEF", 0, WORD(ff_saved_def, synthesis, 4)},
    {"CDEF", 0, WORD(ff_saved_def, mcn_parts, 1u << 11)},
    {"CDEF", 0, WORD(ff_saved_def, model_velocity, 2)},
    {"CDEF", 0, WORD(ff_saved_def, synthesis, 9)},
    {"CDEF", 0, WORD(ff_saved_def, behaviour, 2)},
    {"BSTA", 2, WORD(ff_state_def, choice, 77)},
    {"BCON", 3, WORD(ff_condition_def, index, 77)},
    {"BGOA", 1, REAL(ff_goal_def, place.centre.a, NOT_A_NUMBER)},
    {"SPWN", 0, REAL(ff_spawning, due, NOT_A_NUMBER)},
    {"SHOW", 0, 0, 4, 2},
    {"COND", 0, REAL(ff_conduct, place.a, NOT_A_NUMBER)},
    {"COND", 1, REAL(ff_conduct, speed, 0)},
    {"COND", 1, REAL(ff_conduct, tolerance, BELOW_0)},
    {"COND", 1, REAL(ff_conduct, blocked, BELOW_0)},
    {"COND", 1, REAL(ff_conduct, variable[7], NOT_A_NUMBER)},
    {"COND", 1, REAL(ff_conduct, born, 1u << 20)},
    {"COND", 1, WORD(ff_conduct, state, FAIR_STATES)},
    {"COND", 1, WORD(ff_conduct, goal, FAIR_GOALS)},
    {"COND", 1, WORD(ff_conduct, set, 2)},
    {"COND", 1, WORD(ff_conduct, spawner, 1)},
    {"TRAI", 1, REAL(ff_traits, face_at.b, NOT_A_NUMBER)},
    {"TRAI", 1, WORD(ff_traits, face, FF_FACE_GOAL)},
    {"WALL", 1, REAL(ff_saved_wall, to.a, NOT_A_NUMBER)},
    {"SLIV", 0, 0, 4, 2},
    {"TRAI", 0, REAL(ff_traits, goal.b, NOT_A_NUMBER)},
    {"TRAI", 1, REAL(ff_traits, goal_tolerance, 0)},
    {"TRAI", 1, REAL(ff_traits, preferred_speed, BELOW_0)},
    {"TRAI", 1, REAL(ff_traits, radius, HUGE)},
    {"TRAI", 7, WORD(ff_traits, navigation, 0)},
    {"TRAI", 7, WORD(ff_traits, synthesis, 0)},
    {"MIND", 0, REAL(ff_mind, command.a, NOT_A_NUMBER)},
    {"MIND", 0, REAL(ff_mind, preferred.b, HUGE)},
    {"MIND", 0, REAL(ff_mind, facing, NOT_A_NUMBER)},
    {"MIND", 0, REAL(ff_mind, bias, BELOW_0)},
    {"MIND", 0, REAL(ff_mind, sharp_side, HUGE)},
    {"MIND", 0, REAL(ff_mind, best, NOT_A_NUMBER)},
    {"MIND", 0, REAL(ff_mind, detour, HUGE)},
    {"MIND", 0, REAL(ff_mind, strafing, NOT_A_NUMBER)},
    {"MIND", 0, REAL(ff_mind, measured.a, NOT_A_NUMBER)},
    {"MIND", 0, REAL(ff_mind, stance.ease, HUGE)},
    {"MIND", 0, WORD(ff_mind, stance.foot, 3)},
    {"MIND", 0, WORD(ff_mind, standing, 3)},
    {"BODY", 2, REAL(ff_body, position.a, NOT_A_NUMBER)},
    {"BODY", 2, REAL(ff_body, heading, HUGE)},
    {"BODY", 2, REAL(ff_body, rates.turn, NOT_A_NUMBER)},
    {"BODY", 2, REAL(ff_body, phase, BELOW_0)},
    {"VELO", 3, 8, 8, NOT_A_NUMBER},
    {"GAIT", 4, REAL(ff_gait, foot[1].lock.a, NOT_A_NUMBER)},
    {"GAIT", 4, WORD(ff_gait, foot[1].planted, 2)},
    {"GAIT", 4, WORD(ff_gait, blend.vertex[3], 1u << 20)},
    {"GAIT", 4, WORD(ff_gait, blend.vertex[0], (uint32_t)-2)},
    {"GAIT", 4, REAL(ff_gait, blend.weight[0], BELOW_0)},
    {"GAIT", 4, REAL(ff_gait, blend.period, 0)},
    {"GAIT", 4, REAL(ff_gait, rates.left, NOT_A_NUMBER)},
    {"GAIT", 4, REAL(ff_gait, phase, BELOW_0)},
    {"GAIT", 4, REAL(ff_gait, stand, HUGE)},
    {"GAIT", 4, REAL(ff_gait, idle_time, BELOW_0)},
    {"GAIT", 4, REAL(ff_gait, hips_drop, NOT_A_NUMBER)},
    {"GAIT", 4, REAL(ff_gait, style.stoop, NOT_A_NUMBER)},
    {"GAIT", 4, REAL(ff_gait, blend.stance, BELOW_0)},
    {"GAIT", 4, REAL(ff_gait, blend.hips, HUGE)},
    {"GAIT", 4, WORD(ff_gait, blend.way, FF_LOCOMOTION_COUNT)},
    {"GAIT", 4, WORD(ff_gait, wanted, FF_LOCOMOTION_COUNT)},
    {"GAIT", 4, WORD(ff_gait, urgent, 2)},
    {"GAIT", 4, REAL(ff_gait, offset.age, NOT_A_NUMBER)},
    {"GAIT", 4, WORD(ff_gait, offset.time[0], 0x7fc00000)},
    {"GAIT", 4, WORD(ff_gait, offset.turn[1][20][2], 0x7f000000)},
    {"GAIT", 4, REAL(ff_gait, since_switch, BELOW_0)},
    {"GAIT", 4, REAL(ff_gait, seconds[2], NOT_A_NUMBER)},
    {"GAIT", 4, WORD(ff_gait, mode, 200)},
    {"GAIT", 4, WORD(ff_gait, first_foot, 2)},
    {"CHOI", 4, REAL(ff_choice, calm, BELOW_0)},
    {"CHOI", 4, WORD(ff_choice, control, 2)},
    {"CHOI", 4, WORD(ff_choice, runs, 2)},
};

static void refuse(unsigned char *data, size_t size, const char *section, uint64_t byte)
{
    ff_error error;
    ff_crowd *loaded;
    ff_pack_seal(data, size);
    if (ff_crowd_load(pack, data, size, NULL, &loaded, &error) == FF_OK) {
        print_error("a bad value in %s at byte %llu was accepted\n", section, (unsigned long long)byte);
        fail();
    }
    assert_string_equal(error.section, section);
    if (byte) assert_int_equal(error.byte_offset, byte);
    free(data);
}

static void every_bad_value_is_refused_in_its_own_section_at_its_own_byte(void **state)
{
    (void)state;
    ff_crowd *crowd = ff_saved_crowd(pack);
    for (size_t i = 0; i < sizeof bad_values / sizeof bad_values[0]; ++i) {
        const bad_value *bad = &bad_values[i];
        size_t size;
        unsigned char *data = ff_saved_bytes(crowd, &size);
        const ff_pack_section *section = find_section(data, bad->section);
        uint64_t at = section->offset + (uint64_t)section->stride * bad->index + bad->offset;
        memcpy(data + at, &bad->value, bad->size);
        bool agents = bad->section[0] != 'H' && strcmp(bad->section, "CDEF") != 0 && bad->section[0] != 'W' &&
                      bad->section[0] != 'B' && strcmp(bad->section, "SLIV") != 0;
        refuse(data, size, bad->section, agents ? at : 0);
    }
    ff_crowd_destroy(crowd);
}

static void counts_and_free_slots_that_do_not_fit_together_are_refused(void **state)
{
    (void)state;
    ff_crowd *crowd = ff_saved_crowd(pack);
    size_t size;
    unsigned char *data = ff_saved_bytes(crowd, &size);
    --find_section(data, "MIND")->count;
    find_section(data, "MIND")->size -= sizeof(ff_mind);
    refuse(data, size, "MIND", 0);

    data = ff_saved_bytes(crowd, &size); /* the list begins nowhere, at somebody living, or goes round */
    for (uint32_t first = 0; first < 3; ++first) {
        static const uint32_t wrong[3] = {0, 1, 1u << 30};
        unsigned char *copy = ff_saved_bytes(crowd, &size);
        uint64_t at = find_section(copy, "HEAD")->offset + offsetof(ff_saved_head, free_first);
        memcpy(copy + at, &wrong[first], sizeof wrong[first]);
        refuse(copy, size, "SFRE", 0);
    }
    uint32_t self = 3; /* slot 2 was freed first: its next is none */
    memcpy(data + find_section(data, "SFRE")->offset + 2 * sizeof self, &self, sizeof self);
    refuse(data, size, "SFRE", 0);
    ff_crowd_destroy(crowd);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(saved_loaded_and_continued_equals_never_stopped_to_the_bit),
        cmocka_unit_test(the_same_crowd_gives_the_same_bytes_and_a_loaded_one_gives_them_again),
        cmocka_unit_test(a_crowd_goes_through_a_file_and_only_with_its_own_pack),
        cmocka_unit_test(five_hundred_flips_and_cuts_are_refused_raw_and_harmless_when_sealed),
        cmocka_unit_test(every_bad_value_is_refused_in_its_own_section_at_its_own_byte),
        cmocka_unit_test(counts_and_free_slots_that_do_not_fit_together_are_refused),
    };
    return cmocka_run_group_tests(tests, open_packs, close_packs);
}
