/* report.h - one HTML page that shows what is in a pack: per clip the foot plants, the steps cut from it, what was
 * rejected and why; and the velocity hull. Everything comes from the pack file.
 */
#ifndef FF_REPORT_H
#define FF_REPORT_H

#include "runtime/core/pack/pack.h"

/* Write folder/index.html, all or nothing; creates the folder. */
ff_status ff_report_write(const ff_pack *pack, const char *pack_name, const char *folder, ff_error *error);

/* footfall-pack report ...; argv after the command's name. Returns the exit status. */
int ff_report_command(int argc, char **argv);

#endif
