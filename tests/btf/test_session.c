#include "base/atomic_file.h"
#include "base/picture/image.h"
#include "btf/session/session.h"

#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

static char folder[] = "session-XXXXXX";

static int make_scratch(void **state)
{
    (void)state;
    signal(SIGXFSZ, SIG_IGN);
    return mkdtemp(folder) ? 0 : -1;
}

static int remove_scratch(void **state)
{
    (void)state;
    char command[64];
    snprintf(command, sizeof command, "rm -rf %s", folder);
    return system(command);
}

static weft_angles angles_deg(double theta_deg, double phi_deg)
{
    return (weft_angles){weft_rad_of_deg(theta_deg), weft_rad_of_deg(phi_deg)};
}

enum { SHOTS = 3 };

static weft_shot shots[SHOTS];
static weft_shot_record records[SHOTS];

static weft_session example(void)
{
    shots[0] = (weft_shot){angles_deg(0, 0), angles_deg(75, 345), angles_deg(0, 0)};
    shots[1] = (weft_shot){angles_deg(75, 345), angles_deg(75, 345), angles_deg(70, 345)};
    shots[2] = (weft_shot){angles_deg(15, 60), angles_deg(75, 345), angles_deg(15, 60)};
    memset(records, 0, sizeof records);
    weft_session session = {.folder = folder, .rig = "virtual", .sample = "silk", .rig_settings = "{\"seed\":7}"};
    session.camera = (weft_camera){.width = 416,
                                   .height = 400,
                                   .fx = 3850.25,
                                   .fy = 3845.5,
                                   .cx = 206.3,
                                   .cy = 209.1,
                                   .k1 = -0.35,
                                   .k2 = 1.2,
                                   .p1 = 0.001,
                                   .p2 = -0.002,
                                   .k3 = 3.5,
                                   .vignetting = {-0.4, 0.1, 0.01}};
    session.camera_distance_mm = 1000;
    session.light_distance_mm = 1200;
    session.bits = 12;
    session.black_level = 64;
    session.target = weft_target_for_opening(32);
    session.shot_count = SHOTS;
    session.shot = shots;
    session.record = records;
    return session;
}

static void journal_path(char path[256])
{
    snprintf(path, 256, "%s/journal.jsonl", folder);
}

static void write_journal(const char *text)
{
    char path[256];
    weft_error error = {0};
    journal_path(path);
    assert_int_equal(weft_write_file(path, text, strlen(text), &error), WEFT_OK);
}

static void session_survives_the_round_trip(void **state)
{
    (void)state;
    weft_error error = {0};
    weft_session written = example(), read;
    assert_int_equal(weft_session_create(&written, &error), WEFT_OK);
    assert_int_equal(weft_session_open(folder, &read, &error), WEFT_OK);
    assert_memory_equal(&read.camera, &written.camera, sizeof read.camera);
    assert_memory_equal(&read.target, &written.target, sizeof read.target);
    assert_string_equal(read.rig_settings, "{\"seed\":7}");
    assert_int_equal(read.shot_count, SHOTS);
    assert_true(fabs(read.shot[1].light_driven.theta_rad - weft_rad_of_deg(70)) < 1e-14);
    assert_false(read.record[0].taken);
    char path[256];
    weft_session_photograph_path(&read, 2, path, sizeof path);
    assert_non_null(strstr(path, "/tv075_pv345/tl015_pl060_tv075_pv345.tif"));
    weft_session_free(&read);
}

/* Turns and poses are of all shots, or of none. */
static void places_of_the_axes_survive_the_round_trip(void **state)
{
    (void)state;
    weft_error error = {0};
    weft_session written = example(), read;
    weft_turns turns[SHOTS] = {{{75, -15, 0}}, {{75, -15, 0}}, {{75.25, -15, 3}}};
    weft_motion pose[SHOTS] = {{{3, 0.2, 0.3}, {1, 2, 1000}}, {{3, 0.2, 0.3}, {1, 2, 1000}}, {{3, 0, 0}, {0, 0, 9}}};
    assert_int_equal(weft_session_create(&written, &error), WEFT_OK);
    assert_int_equal(weft_session_open(folder, &read, &error), WEFT_OK);
    assert_null(read.turns);
    assert_null(read.pose);
    weft_pose by_view = weft_session_pose(&read, read.shot[0].view);
    assert_true(fabs(weft_length(weft_pose_camera_position(&by_view)) - 1000) < 1e-9);
    weft_session_free(&read);
    written.turns = turns;
    written.pose = pose;
    assert_int_equal(weft_session_create(&written, &error), WEFT_OK);
    assert_int_equal(weft_session_open(folder, &read, &error), WEFT_OK);
    assert_true(read.turns[2].deg[0] == 75.25 && read.turns[2].deg[2] == 3);
    assert_true(fabs(read.pose[1].rotation[2] - 0.3) < 1e-15 && read.pose[1].translation[2] == 1000);
    weft_pose known = weft_session_pose(&read, read.shot[0].view);
    assert_true(known.translation.y == 2);
    weft_session_free(&read);
}

static void assert_second_pose_is_refused(weft_motion second)
{
    weft_error error = {0};
    weft_session written = example(), read;
    weft_motion pose[SHOTS] = {{{3, 0, 0}, {0, 0, 9}}, second, {{3, 0, 0}, {0, 0, 9}}};
    written.pose = pose;
    assert_int_equal(weft_session_create(&written, &error), WEFT_OK);
    assert_int_equal(weft_session_open(folder, &read, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "session.json': 'pose' of shot 1 of the plan is invalid"));
}

static void poses_that_cannot_be_are_refused(void **state)
{
    (void)state;
    assert_second_pose_is_refused((weft_motion){{3, 0, 0}, {1e7, 0, 9}});
    /* Below the plate, behind it, and in it. */
    assert_second_pose_is_refused((weft_motion){{0.1, 0, 0}, {0, 0, 9}});
    assert_second_pose_is_refused((weft_motion){{0.1, 0, 0}, {0, 0, -9}});
    assert_second_pose_is_refused((weft_motion){{WEFT_PI / 2, 0, 0}, {0, 0, 9}});
}

/* The session with poses and turns in all shots, but that shot `number` lacks what is called `name`. */
static void assert_mix_is_refused(const char *name, int number, const char *said)
{
    weft_error error = {0};
    weft_session written = example(), read;
    weft_turns turns[SHOTS] = {{{0}}};
    weft_motion pose[SHOTS] = {{{3, 0, 0}, {0, 0, 9}}, {{3, 0, 0}, {0, 0, 9}}, {{3, 0, 0}, {0, 0, 9}}};
    char path[256], *text;
    size_t size;
    written.turns = turns;
    written.pose = pose;
    assert_int_equal(weft_session_create(&written, &error), WEFT_OK);
    snprintf(path, sizeof path, "%s/session.json", folder);
    assert_int_equal(weft_read_file(path, 1 << 20, &text, &size, &error), WEFT_OK);
    char *at = strstr(text, name);
    for (int i = 0; i < number; i++)
        at = strstr(at + 1, name);
    at[1] = 'x';
    assert_int_equal(weft_write_file(path, text, size, &error), WEFT_OK);
    free(text);
    assert_int_equal(weft_session_open(folder, &read, &error), WEFT_BAD_INPUT);
    if (!strstr(error.message, said) || !strstr(error.message, "session.json"))
        fail_msg("'%s' does not say '%s'", error.message, said);
}

static void places_of_some_shots_alone_are_refused(void **state)
{
    (void)state;
    assert_mix_is_refused("\"pose\"", 0, "some shots of the plan have 'pose', shot 0 has none");
    assert_mix_is_refused("\"pose\"", 2, "some shots of the plan have 'pose', shot 2 has none");
    assert_mix_is_refused("\"turns_deg\"", 0, "some shots of the plan have 'turns_deg', shot 0 has none");
}

static void a_sample_whose_name_is_not_utf_8_is_described_all_the_same(void **state)
{
    (void)state;
    weft_error error = {0};
    weft_session session = example(), read;
    session.sample = "soi\xe9";
    assert_int_equal(weft_session_create(&session, &error), WEFT_OK);
    assert_int_equal(weft_session_open(folder, &read, &error), WEFT_OK);
    assert_string_equal(read.sample, "soi?");
    weft_session_free(&read);
}

static void journal_gives_back_what_was_appended(void **state)
{
    (void)state;
    weft_error error = {0};
    weft_session session = example(), read;
    write_journal("");
    weft_shot_record record = {
        .taken = true, .viewpoint = 4, .exposure_s = 0.0123456, .bytes = 778954, .crc32 = 0xfedcba98u};
    assert_int_equal(weft_session_append(&session, 2, &record, &error), WEFT_OK);
    assert_int_equal(weft_session_open(folder, &read, &error), WEFT_OK);
    assert_false(read.record[0].taken);
    assert_true(read.record[2].taken);
    assert_int_equal(read.record[2].viewpoint, 4);
    assert_int_equal(read.record[2].crc32, 0xfedcba98u);
    assert_true(read.record[2].exposure_s == 0.0123456);
    weft_session_free(&read);
}

static void cut_last_line_is_forgotten_and_overwritten(void **state)
{
    (void)state;
    weft_error error = {0};
    weft_session session = example(), read;
    write_journal("{\"shot\":0,\"stay\":0,\"exposure_s\":0.5,\"bytes\":10,\"crc32\":1}\n{\"shot\":1,\"st");
    assert_int_equal(weft_session_open(folder, &read, &error), WEFT_OK);
    assert_true(read.record[0].taken);
    assert_false(read.record[1].taken);
    weft_session_free(&read);
    weft_shot_record record = {.taken = true, .viewpoint = 1, .exposure_s = 0.25, .bytes = 20, .crc32 = 2};
    assert_int_equal(weft_session_append(&session, 1, &record, &error), WEFT_OK);
    assert_int_equal(weft_session_open(folder, &read, &error), WEFT_OK);
    assert_true(read.record[1].taken && read.record[1].bytes == 20);
    weft_session_free(&read);
}

static void malformed_journal_line_is_named(void **state)
{
    (void)state;
    static const char *bad[] = {"nonsense\n",
                                "{\"shot\":3,\"stay\":0,\"exposure_s\":0.5,\"bytes\":10,\"crc32\":1}\n",
                                "{\"shot\":-1,\"stay\":0,\"exposure_s\":0.5,\"bytes\":10,\"crc32\":1}\n",
                                "{\"shot\":0,\"stay\":0,\"exposure_s\":0,\"bytes\":10,\"crc32\":1}\n",
                                "{\"shot\":0,\"stay\":0,\"exposure_s\":0.5,\"bytes\":10,\"crc32\":4294967296}\n",
                                "{\"shot\":0,\"stay\":2147483647,\"exposure_s\":0.5,\"bytes\":10,\"crc32\":1}\n"};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        weft_error error = {0};
        weft_session read;
        write_journal(bad[i]);
        assert_int_equal(weft_session_open(folder, &read, &error), WEFT_BAD_INPUT);
        assert_non_null(strstr(error.message, "journal.jsonl"));
        assert_non_null(strstr(error.message, "line 1"));
    }
    write_journal("");
}

static void append_to_a_full_disk_fails_and_loses_nothing(void **state)
{
    (void)state;
    weft_error error = {0};
    weft_session session = example(), read;
    write_journal("{\"shot\":0,\"stay\":0,\"exposure_s\":0.5,\"bytes\":10,\"crc32\":1}\n");
    char path[256];
    struct stat status;
    journal_path(path);
    assert_int_equal(stat(path, &status), 0);
    struct rlimit before, small;
    getrlimit(RLIMIT_FSIZE, &before);
    small = (struct rlimit){(rlim_t)status.st_size + 10, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
    weft_shot_record record = {.taken = true, .viewpoint = 1, .exposure_s = 0.25, .bytes = 20, .crc32 = 2};
    weft_code code = weft_session_append(&session, 1, &record, &error);
    setrlimit(RLIMIT_FSIZE, &before);
    assert_int_equal(code, WEFT_SYSTEM);
    assert_non_null(strstr(error.message, "journal.jsonl"));
    assert_int_equal(weft_session_open(folder, &read, &error), WEFT_OK);
    assert_true(read.record[0].taken);
    assert_false(read.record[1].taken);
    weft_session_free(&read);
}

static void every_cut_of_session_json_is_an_error_that_names_it(void **state)
{
    (void)state;
    weft_error error = {0};
    weft_session session = example(), read;
    assert_int_equal(weft_session_create(&session, &error), WEFT_OK);
    char path[256], *text;
    size_t size;
    snprintf(path, sizeof path, "%s/session.json", folder);
    assert_int_equal(weft_read_file(path, 1 << 20, &text, &size, &error), WEFT_OK);
    for (size_t length = 0; length + 1 < size; length += 7) {
        assert_int_equal(weft_write_file(path, text, length, &error), WEFT_OK);
        assert_int_equal(weft_session_open(folder, &read, &error), WEFT_BAD_INPUT);
        assert_non_null(strstr(error.message, "session.json"));
    }
    free(text);
}

int test_session(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(session_survives_the_round_trip),
        cmocka_unit_test(places_of_the_axes_survive_the_round_trip),
        cmocka_unit_test(poses_that_cannot_be_are_refused),
        cmocka_unit_test(places_of_some_shots_alone_are_refused),
        cmocka_unit_test(a_sample_whose_name_is_not_utf_8_is_described_all_the_same),
        cmocka_unit_test(journal_gives_back_what_was_appended),
        cmocka_unit_test(cut_last_line_is_forgotten_and_overwritten),
        cmocka_unit_test(malformed_journal_line_is_named),
        cmocka_unit_test(append_to_a_full_disk_fails_and_loses_nothing),
        cmocka_unit_test(every_cut_of_session_json_is_an_error_that_names_it),
    };
    return cmocka_run_group_tests(tests, make_scratch, remove_scratch);
}
