#include "tests/reflectance/microcylinder/microcylinder_cloths.h"
#include "tests/reflectance/vectors.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static weft_real degrees(double angle_deg)
{
    return (weft_real)(angle_deg * (double)WEFT_PI / 180);
}

/* Numbers separated by ';'. */
static int list_of(const char *text, weft_real *value, int capacity)
{
    int count = 0;
    for (const char *at = text; *at != '\0' && count < capacity;) {
        char *end;
        value[count++] = (weft_real)strtod(at, &end);
        assert_true(end != at);
        at = *end == ';' ? end + 1 : end;
    }
    return count;
}

static weft_cloth_thread thread_at(const reference_vectors *v, int row)
{
    weft_cloth_thread thread = {
        .axis = strcmp(vectors_text(v, row, "axis"), "x") == 0 ? WEFT_AXIS_X : WEFT_AXIS_Y,
        .sample_count = (int)vectors_number(v, row, "N"),
        .area_share = (weft_real)vectors_number(v, row, "a"),
        .optics = {.eta = (weft_real)vectors_number(v, row, "eta"),
                   .gamma_s = degrees(vectors_number(v, row, "gamma_s_deg")),
                   .gamma_v = degrees(vectors_number(v, row, "gamma_v_deg")),
                   .kd = (weft_real)vectors_number(v, row, "kd"),
                   .albedo = {(weft_real)vectors_number(v, row, "A_r"), (weft_real)vectors_number(v, row, "A_g"),
                              (weft_real)vectors_number(v, row, "A_b")}}};
    thread.point_count = list_of(vectors_text(v, row, "offsets_deg"), thread.tilt_rad, WEFT_THREAD_MAX_POINTS);
    int pieces = list_of(vectors_text(v, row, "lengths"), thread.piece_length, WEFT_THREAD_MAX_POINTS);
    assert_int_equal(pieces, thread.point_count - 1);
    for (int i = 0; i < thread.point_count; i++)
        thread.tilt_rad[i] = degrees(thread.tilt_rad[i]);
    return thread;
}

void reference_cloths_read(reference_cloth cloths[REFERENCE_CLOTHS])
{
    reference_vectors v = vectors_open("microcylinder_cloths.csv", WEFT_CLOTH_THREADS * REFERENCE_CLOTHS);
    for (int i = 0; i < REFERENCE_CLOTHS; i++) {
        int row = WEFT_CLOTH_THREADS * i;
        weft_microcylinder_cloth cloth = {.thread = {thread_at(&v, row), thread_at(&v, row + 1)},
                                          .sigma = degrees(vectors_number(&v, row, "sigma_deg"))};
        snprintf(cloths[i].name, sizeof cloths[i].name, "%s", vectors_text(&v, row, "cloth"));
        cloths[i].prepared = weft_microcylinder_prepare(&cloth);
        assert_true(cloths[i].prepared.admissible);
    }
    weft_csv_free(&v.csv);
}

const weft_prepared_cloth *reference_cloth_named(const reference_cloth cloths[REFERENCE_CLOTHS], const char *name)
{
    for (int i = 0; i < REFERENCE_CLOTHS; i++)
        if (strcmp(cloths[i].name, name) == 0)
            return &cloths[i].prepared;
    fail_msg("no cloth %s", name);
    return NULL;
}
