#include "capture/laboratory/laboratory.h"

#include "base/text/csv.h"
#include "capture/laboratory/lab_camera.h"
#include "capture/motion/lamp_guard.h"
#include "capture/motion/relay.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct weft_laboratory {
    weft_rig_file file;
    weft_laboratory_request request;
    weft_angles *lamp; /* [lamp_count] */
    int lamp_count;
    char *sample;
    weft_controller *controller;
    weft_relay *relay;
    weft_lamp_guard *guard; /* of the lamps of either; NULL: they burn anyway */
    weft_releases releases;
    int camera_count;
    weft_lab_camera camera[WEFT_CAMERAS_MAX]; /* [camera_count] */
};

/* ---- What the rig file names ---- */

static weft_code read_lamp(const weft_csv *csv, int row, const int column[2], weft_angles *lamp, weft_error *error)
{
    double theta_deg, phi_deg;
    WEFT_TRY(weft_csv_number(csv, row, column[0], &theta_deg, error));
    WEFT_TRY(weft_csv_number(csv, row, column[1], &phi_deg, error));
    if (!(theta_deg >= 0 && theta_deg < 90 && phi_deg >= -360 && phi_deg <= 360))
        return weft_fail(error, WEFT_BAD_INPUT, "%s:%d: a lamp at %g, %g degrees is below the table", csv->path,
                         csv->line[row], theta_deg, phi_deg);
    *lamp = (weft_angles){weft_rad_of_deg(theta_deg), weft_rad_of_deg(phi_deg)};
    return WEFT_OK;
}

static weft_code read_rows(weft_laboratory *lab, const weft_csv *csv, weft_error *error)
{
    const int column[2] = {weft_csv_column(csv, "theta_light_deg"), weft_csv_column(csv, "phi_light_deg")};
    if (column[0] < 0 || column[1] < 0 || csv->row_count == 0)
        return weft_fail(error, WEFT_BAD_INPUT, "%s: lamps need the columns theta_light_deg and phi_light_deg",
                         csv->path);
    lab->lamp = calloc((size_t)csv->row_count, sizeof *lab->lamp);
    if (!lab->lamp)
        return weft_fail_memory(error, "lamps", (size_t)csv->row_count * sizeof *lab->lamp);
    for (lab->lamp_count = 0; lab->lamp_count < csv->row_count; lab->lamp_count++)
        WEFT_TRY(read_lamp(csv, lab->lamp_count, column, &lab->lamp[lab->lamp_count], error));
    return WEFT_OK;
}

static weft_code read_lamps(weft_laboratory *lab, weft_error *error)
{
    char path[PATH_MAX];
    weft_csv csv;
    if (!lab->file.axes.lamps)
        return WEFT_OK;
    WEFT_TRY(weft_rig_file_beside(&lab->file, lab->file.light.lamps, path, sizeof path, error));
    WEFT_TRY(weft_csv_read(path, true, &csv, error));
    weft_code code = read_rows(lab, &csv, error);
    weft_csv_free(&csv);
    return code;
}

/* ---- Stage and lamps ---- */

static weft_usb_address address_of(const weft_usb_name *usb)
{
    return (weft_usb_address){(unsigned short)usb->vendor, (unsigned short)usb->product, usb->serial};
}

static weft_code create_controller(weft_laboratory *lab, weft_error *error)
{
    const weft_stage_description *stage = &lab->file.stage;
    const weft_controller_settings settings = {.address = address_of(&stage->usb),
                                               .timeout_s = stage->timeout_s,
                                               .retries = (int)stage->retries,
                                               .replug_s = stage->replug_s,
                                               .poll_s = stage->poll_s,
                                               .tolerance_deg = stage->tolerance_deg,
                                               .stop = lab->request.stop};
    return weft_controller_create(&settings, &lab->file.axes, &lab->controller, error);
}

static weft_code create_relay(weft_laboratory *lab, weft_error *error)
{
    const weft_relay_settings settings = {.address = address_of(&lab->file.light.usb),
                                          .replug_s = lab->file.stage.replug_s,
                                          .retries = (int)lab->file.stage.retries,
                                          .stop = lab->request.stop};
    return weft_relay_create(&settings, &lab->relay, error);
}

static weft_code create_stage(weft_laboratory *lab, weft_error *error)
{
    const weft_rig_file *file = &lab->file;
    weft_stage_parts parts = {.axes = &lab->camera[0].axes,
                              .lamp = lab->lamp,
                              .lamp_count = lab->lamp_count,
                              .lamp_tolerance_rad = weft_rad_of_deg(file->light.lamp_tolerance_deg),
                              .level = file->light.level,
                              .warm_up_s = file->light.warm_up_s,
                              .rig_operator = lab->request.rig_operator,
                              .retries = (int)file->stage.retries};
    if (file->stage.backend == WEFT_STAGE_USB) {
        WEFT_TRY(create_controller(lab, error));
        parts.driver = weft_controller_driver(lab->controller);
    }
    if (file->light.backend == WEFT_LIGHT_STAGE)
        parts.lamps = weft_controller_lamps(lab->controller);
    if (file->light.backend == WEFT_LIGHT_RELAY) {
        WEFT_TRY(create_relay(lab, error));
        parts.lamps = weft_relay_lamps(lab->relay);
    }
    if (parts.lamps.set) {
        WEFT_TRY(weft_lamp_guard_create(parts.lamps, &lab->guard, error));
        parts.lamps = weft_lamp_guard_lamps(lab->guard);
    }
    weft_lab_camera *first = &lab->camera[0];
    WEFT_TRY(weft_stage_create(&parts, &first->stage, error));
    for (weft_lab_camera *c = first + 1; c < first + lab->camera_count; c++)
        WEFT_TRY(weft_stage_create_beside(first->stage, &c->axes, &c->stage, error));
    return WEFT_OK;
}

/* ---- Opening ---- */

static weft_code describe_cameras(weft_laboratory *lab, weft_error *error)
{
    lab->releases.rig_operator = lab->request.rig_operator;
    for (int i = 0; i < lab->file.camera_count; i++) {
        weft_lab_camera *c = &lab->camera[lab->camera_count++];
        WEFT_TRY(weft_lab_camera_describe(&lab->file, i, c, error));
        c->releases = &lab->releases;
        c->stop = lab->request.stop;
    }
    return WEFT_OK;
}

/* What all cameras share. */
static void join_cameras(weft_laboratory *lab)
{
    bool several = lab->camera_count > 1;
    for (int i = 0; i < lab->camera_count; i++) {
        weft_lab_camera *c = &lab->camera[i];
        c->rig.sample = lab->sample;
        c->rig.stage = weft_stage_for_rig(c->stage);
        c->rig.light = weft_stage_light(c->stage);
        c->rig.first = several ? &lab->camera[0].rig : NULL;
        c->rig.next = i + 1 < lab->camera_count ? &lab->camera[i + 1].rig : NULL;
    }
}

static weft_code prepare(weft_laboratory *lab, weft_error *error)
{
    WEFT_TRY(weft_rig_file_read(lab->request.rig_file, &lab->file, error));
    WEFT_TRY(describe_cameras(lab, error));
    WEFT_TRY(read_lamps(lab, error));
    WEFT_TRY(create_stage(lab, error));
    lab->releases.controller = lab->controller;
    lab->sample = strdup(lab->request.sample);
    if (!lab->sample)
        return weft_fail_memory(error, "rig", 0);
    join_cameras(lab);
    return WEFT_OK;
}

weft_code weft_laboratory_open(const weft_laboratory_request *request, weft_laboratory **result, weft_error *error)
{
    weft_laboratory *lab = calloc(1, sizeof *lab);
    if (!lab)
        return weft_fail_memory(error, "rig", sizeof *lab);
    lab->request = *request;
    pthread_mutex_init(&lab->releases.one_question, NULL);
    weft_code code = prepare(lab, error);
    if (code != WEFT_OK) {
        weft_laboratory_close(lab);
        return code;
    }
    *result = lab;
    return WEFT_OK;
}

void weft_laboratory_close(weft_laboratory *lab)
{
    for (int i = lab->camera_count - 1; i >= 0; i--) {
        weft_lab_camera_free(&lab->camera[i]);
        weft_stage_free(lab->camera[i].stage);
    }
    weft_relay_free(lab->relay);
    weft_controller_free(lab->controller);
    weft_lamp_guard_free(lab->guard);
    pthread_mutex_destroy(&lab->releases.one_question);
    free(lab->lamp);
    free(lab->sample);
    free(lab);
}

const char *weft_laboratory_lens(const weft_laboratory *lab, const weft_rig *rig)
{
    const weft_lab_camera *c = lab->camera;
    while (&c->rig != rig)
        c++;
    return c->lens;
}

weft_rig *weft_laboratory_rig(weft_laboratory *lab)
{
    return &lab->camera[0].rig;
}

weft_code weft_laboratory_connect(weft_laboratory *lab, weft_error *error)
{
    for (int i = 0; i < lab->camera_count; i++)
        WEFT_TRY(weft_lab_camera_connect(&lab->camera[i], error));
    return WEFT_OK;
}
