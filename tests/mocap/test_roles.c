/* Roles by the names that tools use, by shape for names that nobody knows, and as the caller says. */
#include "mocap/roles_find.h"
#include "tests/check.h"

#include <stdio.h>

/* A standing person: where the joints are (m, left side; the right one is its mirror image) and what hangs where. */
typedef struct body_joint {
    const char *key; /* what the naming tables call it here */
    ff_role role;
    int parent;
    double x, y, z; /* from the parent */
    bool end_site;
} body_joint;

static const body_joint body[] = {
    {"hips", FF_ROLE_HIPS, -1, 0, 0.95, 0, false},
    {"thigh", FF_ROLE_HIP_L, 0, 0.09, -0.05, 0, false},
    {"shank", FF_ROLE_KNEE_L, 1, 0.01, -0.42, 0, false},
    {"foot", FF_ROLE_ANKLE_L, 2, 0, -0.41, -0.01, false},
    {"toes", FF_ROLE_BALL_L, 3, 0.02, -0.06, 0.14, false},
    {"end", FF_ROLE_TOE_L, 4, 0, 0, 0.06, true},
    {"thigh", FF_ROLE_HIP_R, 0, -0.09, -0.05, 0, false},
    {"shank", FF_ROLE_KNEE_R, 6, -0.01, -0.42, 0, false},
    {"foot", FF_ROLE_ANKLE_R, 7, 0, -0.41, -0.01, false},
    {"toes", FF_ROLE_BALL_R, 8, -0.02, -0.06, 0.14, false},
    {"end", FF_ROLE_TOE_R, 9, 0, 0, 0.06, true},
    {"spine", FF_ROLE_SPINE, 0, 0, 0.1, -0.01, false},
    {"chest", FF_ROLE_CHEST, 11, 0, 0.2, 0, false},
    {"neck", FF_ROLE_NECK, 12, 0, 0.22, 0, false},
    {"head", FF_ROLE_HEAD, 13, 0, 0.1, 0.02, false},
    {"end", FF_ROLE_HEAD_TOP, 14, 0, 0.18, 0, true},
    {"clavicle", FF_ROLE_CLAVICLE_L, 12, 0.03, 0.18, 0, false},
    {"upper", FF_ROLE_SHOULDER_L, 16, 0.14, 0, 0, false},
    {"fore", FF_ROLE_ELBOW_L, 17, 0.05, -0.27, 0, false},
    {"hand", FF_ROLE_WRIST_L, 18, 0.02, -0.25, 0.02, false},
    {"end", FF_ROLE_HAND_L, 19, 0, -0.17, 0, true},
    {"clavicle", FF_ROLE_CLAVICLE_R, 12, -0.03, 0.18, 0, false},
    {"upper", FF_ROLE_SHOULDER_R, 21, -0.14, 0, 0, false},
    {"fore", FF_ROLE_ELBOW_R, 22, -0.05, -0.27, 0, false},
    {"hand", FF_ROLE_WRIST_R, 23, -0.02, -0.25, 0.02, false},
    {"end", FF_ROLE_HAND_R, 24, 0, -0.17, 0, true},
};
enum { BODY_COUNT = sizeof body / sizeof body[0] };

/* Names of one tool; %s-less entries are used on both sides with a prefix or suffix already in them. */
typedef struct naming {
    const char *tool;
    const char *hips, *spine, *chest, *neck, *head;
    const char *left[8], *right[8]; /* thigh shank foot toes clavicle upper fore hand */
} naming;

static const naming tools[] = {
    {"CMU ASF",
     "root",
     "lowerback",
     "thorax",
     "lowerneck",
     "head",
     {"lfemur", "ltibia", "lfoot", "ltoes", "lclavicle", "lhumerus", "lradius", "lwrist"},
     {"rfemur", "rtibia", "rfoot", "rtoes", "rclavicle", "rhumerus", "rradius", "rwrist"}},
    {"cgspeed and LAFAN1",
     "Hips",
     "Spine",
     "Spine2",
     "Neck",
     "Head",
     {"LeftUpLeg", "LeftLeg", "LeftFoot", "LeftToeBase", "LeftShoulder", "LeftArm", "LeftForeArm",
      "LeftHand"},
     {"RightUpLeg", "RightLeg", "RightFoot", "RightToeBase", "RightShoulder", "RightArm", "RightForeArm",
      "RightHand"}},
    {"Mixamo",
     "mixamorig:Hips",
     "mixamorig:Spine",
     "mixamorig:Spine2",
     "mixamorig:Neck",
     "mixamorig:Head",
     {"mixamorig:LeftUpLeg", "mixamorig:LeftLeg", "mixamorig:LeftFoot", "mixamorig:LeftToeBase",
      "mixamorig:LeftShoulder", "mixamorig:LeftArm", "mixamorig:LeftForeArm", "mixamorig:LeftHand"},
     {"mixamorig:RightUpLeg", "mixamorig:RightLeg", "mixamorig:RightFoot", "mixamorig:RightToeBase",
      "mixamorig:RightShoulder", "mixamorig:RightArm", "mixamorig:RightForeArm", "mixamorig:RightHand"}},
    {"Biped",
     "Bip01 Pelvis",
     "Bip01 Spine",
     "Bip01 Spine1",
     "Bip01 Neck",
     "Bip01 Head",
     {"Bip01 L Thigh", "Bip01 L Calf", "Bip01 L Foot", "Bip01 L Toe0", "Bip01 L Clavicle", "Bip01 L UpperArm",
      "Bip01 L Forearm", "Bip01 L Hand"},
     {"Bip01 R Thigh", "Bip01 R Calf", "Bip01 R Foot", "Bip01 R Toe0", "Bip01 R Clavicle", "Bip01 R UpperArm",
      "Bip01 R Forearm", "Bip01 R Hand"}},
    {"Bandai-Namco",
     "Hips",
     "Spine",
     "Chest",
     "Neck",
     "Head",
     {"UpperLeg_L", "LowerLeg_L", "Foot_L", "Toes_L", "Shoulder_L", "UpperArm_L", "LowerArm_L", "Hand_L"},
     {"UpperLeg_R", "LowerLeg_R", "Foot_R", "Toes_R", "Shoulder_R", "UpperArm_R", "LowerArm_R", "Hand_R"}},
    {"Xsens",
     "Hips",
     "Chest",
     "Chest4",
     "Neck",
     "Head",
     {"LeftHip", "LeftKnee", "LeftAnkle", "LeftToe", "LeftCollar", "LeftShoulder", "LeftElbow", "LeftWrist"},
     {"RightHip", "RightKnee", "RightAnkle", "RightToe", "RightCollar", "RightShoulder", "RightElbow",
      "RightWrist"}},
    {"Poser",
     "hip",
     "abdomen",
     "chest",
     "neck",
     "head",
     {"lThigh", "lShin", "lFoot", "lToe", "lCollar", "lShldr", "lForeArm", "lHand"},
     {"rThigh", "rShin", "rFoot", "rToe", "rCollar", "rShldr", "rForeArm", "rHand"}},
    {"Rigify",
     "hips",
     "spine",
     "chest",
     "neck",
     "head",
     {"thigh.L", "shin.L", "foot.L", "toe.L", "shoulder.L", "upper_arm.L", "forearm.L", "hand.L"},
     {"thigh.R", "shin.R", "foot.R", "toe.R", "shoulder.R", "upper_arm.R", "forearm.R", "hand.R"}},
    {"Unreal",
     "pelvis",
     "spine_01",
     "spine_03",
     "neck_01",
     "head",
     {"thigh_l", "calf_l", "foot_l", "ball_l", "clavicle_l", "upperarm_l", "lowerarm_l", "hand_l"},
     {"thigh_r", "calf_r", "foot_r", "ball_r", "clavicle_r", "upperarm_r", "lowerarm_r", "hand_r"}},
    {"SMPL",
     "Pelvis",
     "Spine1",
     "Spine3",
     "Neck",
     "Head",
     {"L_Hip", "L_Knee", "L_Ankle", "L_Foot", "L_Collar", "L_Shoulder", "L_Elbow", "L_Wrist"},
     {"R_Hip", "R_Knee", "R_Ankle", "R_Foot", "R_Collar", "R_Shoulder", "R_Elbow", "R_Wrist"}},
    {"plain",
     "hips",
     "lower back",
     "upper back",
     "neck",
     "head",
     {"left thigh", "left shin", "left foot", "left toes", "left clavicle", "left upper arm", "left forearm",
      "left hand"},
     {"right thigh", "right shin", "right foot", "right toes", "right clavicle", "right upper arm",
      "right forearm", "right hand"}},
    {"nobody's",
     "j0",
     "j1",
     "j2",
     "j3",
     "j4", /* by shape alone */
     {"j5", "j6", "j7", "j8", "j9", "j10", "j11", "j12"},
     {"j13", "j14", "j15", "j16", "j17", "j18", "j19", "j20"}},
};

static const char *name_of(const naming *tool, int joint)
{
    static const char *const keys[8] = {"thigh",    "shank", "foot", "toes",
                                        "clavicle", "upper", "fore", "hand"};
    const body_joint *b = &body[joint];
    if (strcmp(b->key, "hips") == 0) return tool->hips;
    if (strcmp(b->key, "spine") == 0) return tool->spine;
    if (strcmp(b->key, "chest") == 0) return tool->chest;
    if (strcmp(b->key, "neck") == 0) return tool->neck;
    if (strcmp(b->key, "head") == 0) return tool->head;
    for (int i = 0; i < 8; ++i)
        if (strcmp(b->key, keys[i]) == 0)
            return b->x < 0 || ff_role_mirror(b->role) < b->role ? tool->right[i] : tool->left[i];
    return "end";
}

/* One frame; heading turns the whole figure. */
static ff_clip make_clip(const naming *tool, double heading)
{
    static ff_joint joints[BODY_COUNT];
    static ff_quat rotations[BODY_COUNT];
    for (int j = 0; j < BODY_COUNT; ++j) {
        memset(&joints[j], 0, sizeof joints[j]);
        snprintf(joints[j].name, sizeof joints[j].name, "%s", name_of(tool, j));
        joints[j].parent = body[j].parent;
        joints[j].offset = ff_v3(body[j].x, body[j].y, body[j].z);
        joints[j].track = -1;
        joints[j].role = FF_ROLE_NONE;
        joints[j].end_site = body[j].end_site;
        rotations[j] = FF_QUAT_IDENTITY;
    }
    rotations[0] = ff_quat_yaw(heading);
    return (ff_clip){.joints = joints,
                     .joint_count = BODY_COUNT,
                     .frame_count = 1,
                     .frame_time = 0.01,
                     .rotations = rotations};
}

static void every_tools_names_and_unknown_names_give_all_roles(void **state)
{
    (void)state;
    int wrong = 0;
    for (size_t t = 0; t < sizeof tools / sizeof tools[0]; ++t) {
        ff_clip clip = make_clip(&tools[t], 0.7 * (double)t);
        ff_error error;
        FF_ASSERT_OK(ff_roles_find(&clip, NULL, 0, &error), error);
        for (int j = 0; j < BODY_COUNT; ++j) {
            if (clip.joints[j].role == body[j].role) continue;
            print_error("%s: '%s' plays %s, want %s\n", tools[t].tool, clip.joints[j].name,
                        ff_role_name(clip.joints[j].role), ff_role_name(body[j].role));
            ++wrong;
        }
        assert_int_equal(clip.warning_count, 0);
        FF_ASSERT_OK(ff_roles_require(&clip, &error), error);
    }
    assert_int_equal(wrong, 0);
}

static void the_caller_overrides_names(void **state)
{
    (void)state;
    ff_clip clip = make_clip(&tools[1], 0.0);
    const ff_role_override changes[] = {
        {"Spine2", FF_ROLE_NONE}, {"Spine", FF_ROLE_CHEST}, {"LeftArm", FF_ROLE_ELBOW_L}};
    ff_error error;
    FF_ASSERT_OK(ff_roles_find(&clip, changes, 3, &error), error);
    assert_int_equal(clip.joints[11].role, FF_ROLE_CHEST);
    assert_int_equal(clip.joints[12].role, FF_ROLE_NONE);
    assert_int_equal(clip.joints[17].role, FF_ROLE_ELBOW_L);
    assert_int_equal(clip.joints[18].role, FF_ROLE_NONE); /* LeftForeArm lost it */
}

static void an_override_that_names_no_joint_is_refused(void **state)
{
    (void)state;
    ff_clip clip = make_clip(&tools[1], 0.0);
    const ff_role_override change = {"Tail", FF_ROLE_CHEST};
    ff_error error;
    assert_int_equal(ff_roles_find(&clip, &change, 1, &error), FF_ERR_ARGUMENT);
    assert_non_null(strstr(error.message, "'Tail'"));
}

static void a_skeleton_without_legs_is_warned_about_and_not_accepted(void **state)
{
    (void)state;
    ff_clip clip = make_clip(&tools[1], 0.0);
    clip.joint_count = 1;
    ff_error error;
    FF_ASSERT_OK(ff_roles_find(&clip, NULL, 0, &error), error);
    assert_int_equal(clip.warning_count, 1);
    assert_int_equal(ff_roles_require(&clip, &error), FF_ERR_NO_DATA);
    assert_non_null(strstr(error.message, "left hip"));
}

static void role_names_sides_and_parents_are_consistent(void **state)
{
    (void)state;
    for (int i = 0; i < FF_ROLE_COUNT; ++i) {
        ff_role role = (ff_role)i, back;
        assert_true(ff_role_from_name(ff_role_name(role), &back));
        assert_int_equal(back, role);
        assert_int_equal(ff_role_mirror(ff_role_mirror(role)), role);
        assert_int_equal(ff_role_mirror(ff_role_parent(role)), ff_role_parent(ff_role_mirror(role)));
        assert_true((int)ff_role_parent(role) < i);
    }
    ff_role none;
    assert_true(ff_role_from_name("none", &none));
    assert_int_equal(none, FF_ROLE_NONE);
    assert_false(ff_role_from_name("tail", &none));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_tools_names_and_unknown_names_give_all_roles),
        cmocka_unit_test(the_caller_overrides_names),
        cmocka_unit_test(an_override_that_names_no_joint_is_refused),
        cmocka_unit_test(a_skeleton_without_legs_is_warned_about_and_not_accepted),
        cmocka_unit_test(role_names_sides_and_parents_are_consistent),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
