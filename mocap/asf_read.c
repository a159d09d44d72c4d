/* ASF in: the skeleton of an AMC (algorithms A.2).
 *
 * An ASF bone's position is its END. Here every bone becomes a joint at its START (which is its parent's end), with
 * the world vector of the parent bone as offset, so that hip, knee and ankle are where they are in a BVH; leaf bones get
 * an end site.
 */
#include "mocap/read.h"
#include "mocap/text.h"
#include "runtime/core/base/memory.h"

#include <stdlib.h>
#include <string.h>

typedef struct bone_text {
    ff_vec3 direction, axis;
    double length;
    unsigned char axis_order[3];
    uint32_t line;
    int parent, first_child, last_child, next_sibling; /* bones; -1 = none */
} bone_text;

typedef struct reader {
    ff_text text;
    bool strict;
    ff_asf *asf;
    ff_clip oddities;      /* only its warning is used */
    ff_array bones, texts; /* ff_asf_bone, bone_text; the root is the first */
    ff_error *error;
} reader;

static ff_asf_bone *bone_at(reader *r, int i)
{
    return (ff_asf_bone *)r->bones.data + i;
}

static bone_text *text_at(reader *r, int i)
{
    return (bone_text *)r->texts.data + i;
}

static ff_status add_bone(reader *r, const char *at)
{
    if (r->bones.count >= FF_CLIP_MAX_JOINTS)
        return ff_text_fail(&r->text, at, FF_ERR_RANGE, r->error, "more than %d bones", FF_CLIP_MAX_JOINTS);
    ff_asf_bone *bone = ff_array_grow(&r->bones, 1, sizeof *bone);
    bone_text *text = ff_array_grow(&r->texts, 1, sizeof *text);
    if (!bone || !text) return ff_fail(r->error, FF_ERR_NO_MEMORY, "no memory for the bones");
    memset(bone, 0, sizeof *bone);
    *text = (bone_text){.axis_order = {0, 1, 2},
                        .line = r->text.line,
                        .parent = -1,
                        .first_child = -1,
                        .last_child = -1,
                        .next_sibling = -1};
    return FF_OK;
}

static int find_bone(reader *r, ff_word word)
{
    for (int i = 0; i < (int)r->bones.count; ++i) {
        const char *name = bone_at(r, i)->name;
        if (strlen(name) == word.length && memcmp(name, word.begin, word.length) == 0) return i;
    }
    return -1;
}

static ff_status read_unit(reader *r, ff_word key)
{
    if (ff_word_is(key, "mass")) return FF_OK;
    if (ff_word_is(key, "length")) {
        const char *at = ff_skip_blanks(r->text.cursor);
        ff_status status = ff_text_number(&r->text, "the length unit", &r->asf->length, r->error);
        if (status == FF_OK && !(r->asf->length >= 1e-6))
            status = ff_text_fail(&r->text, at, FF_ERR_RANGE, r->error,
                                  "a length unit of %g is absurd (CMU: 0.45)", r->asf->length);
        return status;
    }
    if (ff_word_is(key, "angle")) {
        ff_word value = ff_text_word(&r->text);
        r->asf->degrees = ff_word_is(value, "deg") || ff_word_is(value, "degrees");
        if (r->asf->degrees || ff_word_is(value, "rad") || ff_word_is(value, "radians")) return FF_OK;
        return ff_text_fail(&r->text, value.begin, FF_ERR_PARSE, r->error,
                            "angle unit '%s', expected deg or rad", ff_word_quote(value).text);
    }
    return ff_text_odd(&r->text, key.begin, r->strict, &r->oddities, r->error, "unknown unit '%s'",
                       ff_word_quote(key).text);
}

/* "XYZ" in any order. */
static ff_status read_axis_order(reader *r, unsigned char order[3])
{
    ff_word word = ff_text_word(&r->text);
    unsigned seen = 0;
    for (size_t i = 0; i < word.length && i < 3; ++i) {
        int axis = (word.begin[i] | 0x20) - 'x';
        if (axis < 0 || axis > 2) break;
        order[i] = (unsigned char)axis;
        seen |= 1u << axis;
    }
    if (word.length == 3 && seen == 7) return FF_OK;
    return ff_text_fail(&r->text, word.begin, FF_ERR_PARSE, r->error,
                        "axis order '%s', expected one like XYZ", ff_word_quote(word).text);
}

static int dof_of(ff_word word)
{
    static const char *const names[] = {"rx", "ry", "rz", "tx", "ty", "tz"};
    for (int i = 0; i < 6; ++i)
        if (ff_word_is(word, names[i])) return i;
    return -1;
}

static ff_status read_dof(reader *r, int index, int most)
{
    ff_asf_bone *bone = bone_at(r, index);
    unsigned seen = 0;
    bone->dof_count = 0;
    for (;;) {
        ff_word word = ff_text_word(&r->text);
        if (word.length == 0) return FF_OK;
        int dof = dof_of(word);
        if (dof < 0 || dof >= most)
            return ff_text_fail(
                &r->text, word.begin, dof < 0 && !ff_word_is(word, "l") ? FF_ERR_PARSE : FF_ERR_UNSUPPORTED,
                r->error, "degree of freedom '%s', expected rx, ry%s", ff_word_quote(word).text,
                most > 3 ? ", rz, tx, ty or tz" : " or rz (bones that change length are not supported)");
        if (seen & 1u << dof)
            return ff_text_fail(&r->text, word.begin, FF_ERR_PARSE, r->error, "degree of freedom '%s' twice",
                                ff_word_quote(word).text);
        seen |= 1u << dof;
        bone->dof[bone->dof_count++] = (unsigned char)dof;
    }
}

static ff_status read_root(reader *r, ff_word key)
{
    bone_text *root = text_at(r, 0);
    if (ff_word_is(key, "order")) return read_dof(r, 0, 6);
    if (ff_word_is(key, "axis")) return read_axis_order(r, root->axis_order);
    if (ff_word_is(key, "position"))
        return ff_text_vec3(&r->text, "the root's position", &r->asf->position, r->error);
    if (ff_word_is(key, "orientation"))
        return ff_text_vec3(&r->text, "the root's orientation", &root->axis, r->error);
    return ff_text_odd(&r->text, key.begin, r->strict, &r->oddities, r->error, "unknown root entry '%s'",
                       ff_word_quote(key).text);
}

static ff_status read_bone_name(reader *r, int index)
{
    ff_word word = ff_text_word(&r->text);
    if (word.length == 0)
        return ff_text_fail(&r->text, word.begin, FF_ERR_PARSE, r->error, "the bone has no name");
    if (find_bone(r, word) >= 0)
        return ff_text_fail(&r->text, word.begin, FF_ERR_PARSE, r->error, "a second bone '%s'",
                            ff_word_quote(word).text);
    if (!ff_word_to_name(word, bone_at(r, index)->name))
        return ff_text_fail(&r->text, word.begin, FF_ERR_RANGE, r->error,
                            "a bone's name has more than 63 characters");
    return FF_OK;
}

static ff_status read_bone(reader *r, ff_word key)
{
    int index = (int)r->bones.count - 1;
    bone_text *text = text_at(r, index);
    if (ff_word_is(key, "name")) return read_bone_name(r, index);
    if (ff_word_is(key, "direction"))
        return ff_text_vec3(&r->text, "the bone's direction", &text->direction, r->error);
    if (ff_word_is(key, "dof")) return read_dof(r, index, 3);
    if (ff_word_is(key, "length")) {
        const char *at = ff_skip_blanks(r->text.cursor);
        ff_status status = ff_text_number(&r->text, "the bone's length", &text->length, r->error);
        if (status == FF_OK && text->length < 0.0)
            status = ff_text_fail(&r->text, at, FF_ERR_RANGE, r->error, "a bone of negative length");
        return status;
    }
    if (ff_word_is(key, "axis")) {
        ff_status status = ff_text_vec3(&r->text, "the bone's axis", &text->axis, r->error);
        return status == FF_OK ? read_axis_order(r, text->axis_order) : status;
    }
    /* Limits are not what a pose needs, and dof must not be inferred from them. */
    if (ff_word_is(key, "id") || ff_word_is(key, "limits") || *key.begin == '(' ||
        ff_word_is(key, "bodymass") || ff_word_is(key, "cofmass"))
        return FF_OK;
    return ff_text_odd(&r->text, key.begin, r->strict, &r->oddities, r->error, "unknown bone entry '%s'",
                       ff_word_quote(key).text);
}

static ff_status read_children(reader *r, ff_word key)
{
    int parent = find_bone(r, key);
    if (parent < 0)
        return ff_text_fail(&r->text, key.begin, FF_ERR_PARSE, r->error, "bone '%s' is not in :bonedata",
                            ff_word_quote(key).text);
    for (;;) {
        ff_word word = ff_text_word(&r->text);
        if (word.length == 0) return FF_OK;
        int child = find_bone(r, word);
        if (child < 0)
            return ff_text_fail(&r->text, word.begin, FF_ERR_PARSE, r->error, "bone '%s' is not in :bonedata",
                                ff_word_quote(word).text);
        if (child == 0 || text_at(r, child)->parent >= 0)
            return ff_text_fail(&r->text, word.begin, FF_ERR_PARSE, r->error,
                                "bone '%s' has a parent already", ff_word_quote(word).text);
        bone_text *p = text_at(r, parent);
        text_at(r, child)->parent = parent;
        if (p->last_child < 0) {
            p->first_child = child;
        } else {
            text_at(r, p->last_child)->next_sibling = child;
        }
        p->last_child = child;
    }
}

typedef enum section {
    SECTION_NONE,
    SECTION_IGNORED,
    SECTION_UNITS,
    SECTION_ROOT,
    SECTION_BONES,
    SECTION_TREE
} section;

static ff_status section_of(reader *r, ff_word word, section *out)
{
    static const char *const ignored[] = {":version", ":name", ":documentation", ":skin", ":limits"};
    *out = SECTION_IGNORED;
    if (ff_word_is(word, ":units")) *out = SECTION_UNITS;
    if (ff_word_is(word, ":root")) *out = SECTION_ROOT;
    if (ff_word_is(word, ":bonedata")) *out = SECTION_BONES;
    if (ff_word_is(word, ":hierarchy")) *out = SECTION_TREE;
    if (*out != SECTION_IGNORED) return FF_OK;
    for (size_t i = 0; i < sizeof ignored / sizeof ignored[0]; ++i)
        if (ff_word_is(word, ignored[i])) return FF_OK;
    return ff_text_odd(&r->text, word.begin, r->strict, &r->oddities, r->error, "unknown section '%s'",
                       ff_word_quote(word).text);
}

/* A line inside :bonedata or :hierarchy; inside says whether a begin is open. */
static ff_status read_block_line(reader *r, ff_word word, section where, bool *inside)
{
    bool begin = ff_word_is(word, "begin"), end = ff_word_is(word, "end");
    if (begin || end) {
        if (begin == *inside)
            return ff_text_fail(&r->text, word.begin, FF_ERR_PARSE, r->error,
                                begin ? "'begin' before the 'end' of the one before"
                                      : "'end' without 'begin'");
        *inside = begin;
        if (where != SECTION_BONES) return FF_OK;
        if (begin) return add_bone(r, word.begin);
        if (bone_at(r, (int)r->bones.count - 1)->name[0]) return FF_OK;
        return ff_text_fail(&r->text, word.begin, FF_ERR_PARSE, r->error, "the bone has no name");
    }
    if (!*inside)
        return ff_text_fail(&r->text, word.begin, FF_ERR_PARSE, r->error, "'%s' where 'begin' is expected",
                            ff_word_quote(word).text);
    return where == SECTION_BONES ? read_bone(r, word) : read_children(r, word);
}

static ff_status read_lines(reader *r)
{
    section where = SECTION_NONE;
    bool inside = false;
    for (; ff_text_skip(&r->text, true); ff_text_next_line(&r->text)) {
        ff_word word = ff_text_word(&r->text);
        ff_status status = FF_OK;
        if (*word.begin == ':') {
            if (inside)
                return ff_text_fail(&r->text, word.begin, FF_ERR_PARSE, r->error,
                                    "'end' is missing before '%s'", ff_word_quote(word).text);
            status = section_of(r, word, &where);
        } else if (where == SECTION_NONE) {
            status = ff_text_fail(&r->text, word.begin, FF_ERR_PARSE, r->error,
                                  "'%s' before any section: this is no ASF", ff_word_quote(word).text);
        } else if (where == SECTION_UNITS) {
            status = read_unit(r, word);
        } else if (where == SECTION_ROOT) {
            status = read_root(r, word);
        } else if (where != SECTION_IGNORED) {
            status = read_block_line(r, word, where, &inside);
        }
        if (status != FF_OK) return status;
    }
    if (inside) return ff_text_fail(&r->text, NULL, FF_ERR_PARSE, r->error, "the file ends before 'end'");
    if (r->bones.count < 2)
        return ff_text_fail(&r->text, NULL, FF_ERR_NO_DATA, r->error, "the skeleton has no bone");
    return FF_OK;
}

/* "XYZ" turns about fixed x first, then y, then z: the last one is the leftmost factor. */
static void set_axis(ff_asf_bone *bone, const bone_text *text, double to_radians)
{
    const double angles[3] = {text->axis.x, text->axis.y, text->axis.z};
    ff_quat q = FF_QUAT_IDENTITY;
    for (int i = 2; i >= 0; --i) {
        double s, c;
        ff_sincos(0.5 * to_radians * angles[text->axis_order[i]], &s, &c);
        q = ff_quat_turn(q, text->axis_order[i], s, c);
    }
    bone->turned = q.x != 0.0 || q.y != 0.0 || q.z != 0.0;
    for (int i = 0; i < 3; ++i) {
        ff_vec3 column = ff_quat_rotate(q, ff_v3(i == 0, i == 1, i == 2));
        bone->axis[i] = column.x, bone->axis[3 + i] = column.y, bone->axis[6 + i] = column.z;
    }
}

static ff_joint *add_joint(ff_asf *asf, const char *name, int parent, ff_vec3 offset)
{
    ff_joint *joint = &asf->joints[asf->joint_count++];
    *joint =
        (ff_joint){.parent = parent, .offset = offset, .track = parent < 0 ? 0 : -1, .role = FF_ROLE_NONE};
    memcpy(joint->name, name, sizeof joint->name);
    return joint;
}

static void add_end_site(ff_asf *asf, const ff_asf_bone *bone, ff_vec3 offset)
{
    ff_joint *joint = add_joint(asf, bone->name, bone->joint, offset);
    joint->name[59] = '\0';
    memcpy(joint->name + strlen(joint->name), "_end", 5);
    joint->end_site = true;
}

/* Depth first, children in the order of the file, without recursion. */
static ff_status build_joints(reader *r)
{
    ff_asf *asf = r->asf;
    asf->joints = ff_calloc(2 * r->bones.count, sizeof *asf->joints);
    if (!asf->joints) return ff_fail(r->error, FF_ERR_NO_MEMORY, "no memory for the joints");
    int placed = 0;
    for (int b = 0; b >= 0;) {
        const bone_text *text = text_at(r, b);
        ff_asf_bone *bone = bone_at(r, b);
        bone->joint = asf->joint_count;
        ff_vec3 start = asf->position;
        if (b > 0) start = ff_scale3(text_at(r, text->parent)->direction, text_at(r, text->parent)->length);
        add_joint(asf, bone->name, b > 0 ? bone_at(r, text->parent)->joint : -1, start);
        set_axis(bone, text, r->asf->degrees ? FF_DEG : 1.0);
        if (b > 0 && text->first_child < 0) add_end_site(asf, bone, ff_scale3(text->direction, text->length));
        ++placed;
        for (b = text->first_child; b < 0 && text->parent >= 0; text = text_at(r, text->parent))
            b = text->next_sibling;
    }
    if (asf->joint_count > FF_CLIP_MAX_JOINTS)
        return ff_fail(r->error, FF_ERR_RANGE, "more than %d joints", FF_CLIP_MAX_JOINTS);
    if (placed == (int)r->bones.count) return FF_OK;
    for (int b = 1; b < (int)r->bones.count; ++b)
        if (bone_at(r, b)->joint == 0) r->text.line = text_at(r, b)->line, placed = b;
    return ff_text_fail(&r->text, NULL, FF_ERR_PARSE, r->error, "bone '%s' hangs from nothing in :hierarchy",
                        bone_at(r, placed)->name);
}

static ff_status read_all(reader *r)
{
    ff_status status = add_bone(r, NULL);
    if (status != FF_OK) return status;
    memcpy(bone_at(r, 0)->name, "root", 5);
    status = read_lines(r);
    if (status != FF_OK) return status;
    return build_joints(r);
}

ff_status ff_asf_parse(const char *data, size_t size, const char *name, bool strict, ff_asf *out,
                       ff_error *error)
{
    memset(out, 0, sizeof *out);
    out->degrees = true;
    reader r = {.strict = strict, .asf = out, .error = error};
    ff_status status = ff_text_start(&r.text, data, size, name, error);
    if (status == FF_OK) status = read_all(&r);
    ff_text_end(&r.text);
    ff_array_free(&r.texts);
    out->bones = r.bones.data;
    out->bone_count = (int)r.bones.count;
    out->warning_count = r.oddities.warning_count;
    memcpy(out->warning, r.oddities.warning, sizeof out->warning);
    if (status != FF_OK) {
        ff_error_in_file(error, name);
        ff_asf_free(out);
    }
    return status;
}

void ff_asf_free(ff_asf *asf)
{
    free(asf->joints);
    free(asf->bones);
    memset(asf, 0, sizeof *asf);
}
