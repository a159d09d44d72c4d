/* damage.c - a real pack, damaged many times: every damaged copy must be refused, or used without harm.
 *
 *   damage PACK COUNT [SEED]
 *
 * In turn: one byte flipped; the file cut short; and both again with sizes and checksum made good, so that the checks
 * behind the checksum are reached. A copy that opens is used for a short walk of a few people. Run under sanitizers
 * this finds reads outside the file. Prints how many copies were refused; a fault ends the program. */
#include "runtime/core/base/file.h"
#include "runtime/core/base/random.h"
#include "tests/core/pack_seal.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PEOPLE = 3, STEPS = 40, FRONT = 2048 /* bytes: header, section table and the first small sections */ };

static uint64_t below(ff_random *random, uint64_t limit)
{
    return ff_random_next(random) % limit;
}

/* Flip one byte, half of the time near the front where the structure is. */
static void flip(unsigned char *data, size_t size, ff_random *random)
{
    uint64_t range = below(random, 2) && size > FRONT ? FRONT : size;
    data[below(random, range)] ^= (unsigned char)(1 + below(random, 255));
}

static void make_good(unsigned char *data, size_t size)
{
    if (size < sizeof(ff_pack_header)) return;
    uint64_t file_size = size;
    memcpy(data + offsetof(ff_pack_header, file_size), &file_size, sizeof file_size);
    ff_pack_seal(data, size);
}

static void walk(ff_crowd *crowd, uint32_t joints)
{
    ff_agent agents[PEOPLE];
    ff_vec3 hips;
    ff_quat *rotations = calloc(joints, sizeof *rotations);
    for (int i = 0; i < PEOPLE; ++i) {
        ff_agent_def person = ff_agent_def_default();
        person.position = (ff_vec2){2.0 * i, 0.5 * i};
        person.goal = (ff_vec2){-3.0 * i, 4.0};
        if (ff_crowd_add_agent(crowd, &person, &agents[i], NULL) != FF_OK) agents[i] = (ff_agent){0, 0};
    }
    for (int step = 0; rotations && step < STEPS; ++step) {
        ff_crowd_step(crowd);
        for (int i = 0; i < PEOPLE; ++i)
            ff_crowd_agent_pose(crowd, agents[i], &hips, rotations, NULL); /* a stale handle is refused */
    }
    free(rotations);
}

/* True when the bytes were refused. */
static bool try_pack(const unsigned char *data, size_t size)
{
    ff_pack *pack;
    ff_crowd *crowd;
    ff_error error = {.status = FF_OK};
    if (ff_pack_open_memory(data, size, &pack, &error) != FF_OK) {
        if (error.message[0]) return true;
        fputs("damage: refused without a word\n", stderr);
        exit(1);
    }
    size_t letters = 0;
    for (uint32_t j = 0; j < ff_pack_joint_count(pack); ++j)
        letters += strlen(ff_pack_joint_name(pack, j));
    ff_crowd_def def = ff_crowd_def_default();
    def.max_agents = PEOPLE;
    if (letters < size && ff_crowd_create(pack, &def, &crowd, NULL) == FF_OK) {
        walk(crowd, ff_pack_joint_count(pack));
        ff_crowd_destroy(crowd);
    }
    ff_pack_close(pack);
    return false;
}

int main(int argc, char **argv)
{
    ff_error error;
    ff_file file;
    if (argc < 3) return fputs("usage: damage PACK COUNT [SEED]\n", stderr), 2;
    long count = strtol(argv[2], NULL, 10), refused = 0;
    ff_random random = {.seed = argc > 3 ? strtoull(argv[3], NULL, 10) : 1};
    if (ff_file_map(argv[1], &file, &error) != FF_OK || file.size == 0)
        return fprintf(stderr, "damage: cannot read %s\n", argv[1]), 1;
    for (long i = 0; i < count; ++i) {
        size_t size = i % 2 ? (size_t)below(&random, file.size) : file.size;
        void *copy = NULL; /* of exactly this size, so that a read behind its end is seen */
        if (posix_memalign(&copy, 64, size ? size : 1) != 0) return fputs("damage: no memory\n", stderr), 1;
        memcpy(copy, file.data, size);
        if (i % 2 == 0) flip(copy, size, &random);
        if (i % 4 >= 2) make_good(copy, size);
        refused += try_pack(copy, size);
        free(copy);
    }
    ff_file_unmap(&file);
    printf("%ld of %ld damaged copies refused, %ld used without harm\n", refused, count, count - refused);
    return 0;
}
