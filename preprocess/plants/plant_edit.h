/* plant_edit.h - what a person wrote about a clip's foot plants (NAME.plants.json beside the clip): it wins over what
 * was found. */
#ifndef FF_PLANT_EDIT_H
#define FF_PLANT_EDIT_H

#include "preprocess/plants/plants.h"

typedef enum ff_edit_kind { FF_EDIT_ADD, FF_EDIT_REMOVE, FF_EDIT_MOVE } ff_edit_kind;
enum { FF_EDIT_LEAVE = -2 }; /* a frame that is not to be changed; flat_* -1: never flat */

typedef struct ff_plant_edit {
    ff_edit_kind kind;
    int foot;
    int frame;      /* remove, move: any frame of the found plant */
    int start, end; /* add, move */
    int flat_start, flat_end;
    uint32_t line, column; /* in the file, for complaints */
} ff_plant_edit;

struct ff_plant_edits {
    ff_plant_edit *items; /* in the order of the file */
    int count;
    bool all;        /* the file lists every plant: what was found does not count */
    char path[1024]; /* of the file */
};

/* Read a file's text. On failure *out is zeroed. */
ff_status ff_plant_edits_parse(const char *text, size_t size, const char *path, ff_plant_edits *out,
                               ff_error *error);

/* Read the file that belongs to a clip's file, if there is one (*found). */
ff_status ff_plant_edits_load(const char *clip_path, ff_plant_edits *out, bool *found, ff_error *error);
void ff_plant_edits_free(ff_plant_edits *edits);

/* Where the file of a clip's file is; false when the name is too long. */
bool ff_plant_edits_path(const char *clip_path, char *path, size_t size);

/* For a clip of which only frames first to first + frame_count - 1 are kept: frames then count from first, and what
 * lies outside is dropped or cut. */
void ff_plant_edits_trim(ff_plant_edits *edits, int first, int frame_count);

/* A file that lists every plant as it is, for a person to go on from. The caller frees *text. */
ff_status ff_plant_edits_write(const ff_plants *plants, char **text, ff_error *error);

/* On one foot's plants as they were found (detected; their count), give those that hold: written ones marked. *out has
 * room for count + edits->count. frame_count: of the clip. */
ff_status ff_plant_edits_apply(const ff_plant_edits *edits, int foot, int frame_count, const ff_plant *found,
                               int count, ff_plant *out, int *out_count, ff_error *error);

#endif
