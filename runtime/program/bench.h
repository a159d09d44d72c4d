/* bench.h - `footfall-crowd bench NAME`: measurements, printed as a table and written as CSV, JSON and a picture. */
#ifndef FF_BENCH_H
#define FF_BENCH_H

#include "runtime/core/base/fail.h"
#include "runtime/program/bench_options.h"

#include <jansson.h>

/* argv starts after the word "bench". Returns the exit status; so do the benches, which start after their names. */
int ff_bench_main(int argc, char **argv);
int ff_bench_table1_main(int argc, char **argv);
int ff_bench_fig6_main(int argc, char **argv);
int ff_bench_fig7_main(int argc, char **argv);
int ff_bench_astar_main(int argc, char **argv);
int ff_bench_synthesis_main(int argc, char **argv);
int ff_bench_hybrid_main(int argc, char **argv);
int ff_bench_walk_main(int argc, char **argv);
int ff_bench_fig9_main(int argc, char **argv);
int ff_bench_fig10_main(int argc, char **argv);
int ff_bench_mixed_main(int argc, char **argv);
int ff_bench_facts_main(int argc, char **argv);

/* Write value where --json says and as NAME.json into the folder of --out, made if missing; where neither is given,
 * nowhere. Gives value back to jansson; NULL means that memory ran out. */
ff_status ff_bench_write_json(const ff_bench_options *options, const char *name, json_t *value,
                              ff_error *error);

#endif
