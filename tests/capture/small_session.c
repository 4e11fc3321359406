#include "tests/capture/small_session.h"

#include "base/picture/image.h"
#include "capture/photograph_writer.h"
#include "tests/support/cmocka_all.h"
#include "tests/support/scratch_folder.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <zlib.h>

static void write_plan(void)
{
    static const double angles[5][2] = {{0, 0}, {30, 0}, {45, 120}, {60, 240}, {75, 15}};
    FILE *file = fopen("plan.csv", "w");
    assert_non_null(file);
    fputs("theta_light_deg,phi_light_deg,theta_view_deg,phi_view_deg\n", file);
    for (int i = 0; i < SMALL_SHOTS; i++) {
        const double *light = angles[i % 5], *view = angles[i / 5];
        fprintf(file, "%g,%g,%g,%g\n", light[0], light[1], view[0], view[1]);
    }
    assert_int_equal(fclose(file), 0);
}

virtual_session small_session_request(void)
{
    write_plan();
    virtual_session request = {.rig = {.seed = 1, .settings = weft_virtual_settings_default()}};
    request.capture.folder = "session";
    request.capture.plan = "plan.csv";
    request.rig.sample = WEFT_ASSETS "/weaves/polyester_lining.wv";
    request.truth.size = 4;
    request.truth.image_count = 5;
    request.rig.settings.rig.width_px = request.rig.settings.rig.height_px = SMALL_SIZE;
    request.rig.settings.rig.focal_length_px = 440;
    request.rig.settings.samples_per_pixel = 2;
    return request;
}

static void assert_photograph_matches(const weft_session *session, int shot)
{
    static uint16_t samples[SMALL_SIZE * SMALL_SIZE * 3];
    char path[PATH_MAX];
    uint64_t bytes;
    uint32_t crc;
    weft_session_photograph_path(session, shot, path, sizeof path);
    assert_true(session->record[shot].taken);
    assert_int_equal(weft_file_crc(path, &bytes, &crc, NULL), WEFT_OK);
    assert_int_equal(bytes, session->record[shot].bytes);
    assert_int_equal(crc, session->record[shot].crc32);
    assert_int_equal(weft_photograph_read(path, SMALL_SIZE, SMALL_SIZE, session->bits, samples, NULL), WEFT_OK);
}

/* Every line is complete and names another shot. */
static void assert_journal_names_each_shot_once(const char *folder)
{
    char path[PATH_MAX];
    bool named[SMALL_SHOTS] = {false};
    size_t size;
    snprintf(path, sizeof path, "%s/journal.jsonl", folder);
    char *text = (char *)scratch_load(path, &size);
    assert_true(size > 0 && text[size - 1] == '\n');
    text[size] = '\0';
    for (char *line = strtok(text, "\n"); line; line = strtok(NULL, "\n")) {
        int shot = -1;
        assert_int_equal(sscanf(line, "{\"shot\":%d,", &shot), 1);
        assert_in_range(shot, 0, SMALL_SHOTS - 1);
        assert_false(named[shot]);
        named[shot] = true;
    }
    free(text);
    for (int shot = 0; shot < SMALL_SHOTS; shot++)
        assert_true(named[shot]);
}

void small_session_assert_whole(const char *folder)
{
    weft_session session;
    assert_int_equal(weft_session_open(folder, &session, NULL), WEFT_OK);
    assert_int_equal(session.shot_count, SMALL_SHOTS);
    for (int shot = 0; shot < SMALL_SHOTS; shot++)
        assert_photograph_matches(&session, shot);
    weft_session_free(&session);
    assert_journal_names_each_shot_once(folder);
    char path[PATH_MAX];
    snprintf(path, sizeof path, "%s/.photograph.tif", folder);
    assert_int_not_equal(access(path, F_OK), 0);
}

uint32_t small_session_crc(const char *folder)
{
    weft_session session;
    uLong crc = crc32(0, Z_NULL, 0);
    assert_int_equal(weft_session_open(folder, &session, NULL), WEFT_OK);
    for (int shot = 0; shot < session.shot_count; shot++) {
        char path[PATH_MAX];
        size_t size;
        weft_session_photograph_path(&session, shot, path, sizeof path);
        unsigned char *bytes = scratch_load(path, &size);
        crc = crc32(crc, bytes, (uInt)size);
        free(bytes);
    }
    weft_session_free(&session);
    return (uint32_t)crc;
}

int small_session_journal_lines(const char *folder)
{
    char path[PATH_MAX];
    snprintf(path, sizeof path, "%s/journal.jsonl", folder);
    FILE *file = fopen(path, "r");
    int lines = 0;
    for (int c; file && (c = fgetc(file)) != EOF;)
        lines += c == '\n';
    if (file)
        fclose(file);
    return lines;
}
