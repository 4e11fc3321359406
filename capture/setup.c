#include "capture/setup.h"

#include "capture/file_crc.h"
#include "capture/plan.h"

#include <stdlib.h>
#include <string.h>

weft_capture_request weft_capture_request_default(void)
{
    return (weft_capture_request){.plan = "ubo81",
                                  .seed = 1,
                                  .settings = weft_rig_settings_default(),
                                  .truth_size = 64,
                                  .truth_images = WEFT_UBO81_COUNT};
}

static const char *base_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

/* Takes the shots of the plan. */
static weft_code adopt_plan(const weft_capture_request *request, weft_session *session, weft_error *error)
{
    weft_plan plan;
    WEFT_TRY(weft_plan_read(request->plan, &plan, error));
    weft_plan_avoid_camera(&plan, weft_rad_of_deg(request->settings.camera_half_angle_deg));
    session->shot_count = plan.shot_count;
    session->shot = plan.shot;
    session->record = calloc((size_t)plan.shot_count, sizeof *session->record);
    return session->record ? WEFT_OK : weft_fail_memory(error, "plan", (size_t)plan.shot_count * sizeof(weft_shot));
}

static weft_code describe(const weft_capture_request *request, const char *sample_name, weft_session *session,
                          weft_error *error)
{
    const weft_rig_settings *settings = &request->settings;
    uint64_t bytes;
    uint32_t crc32;
    WEFT_TRY(weft_file_crc(request->sample, &bytes, &crc32, error));
    session->folder = strdup(request->folder);
    session->rig = strdup("virtual");
    session->sample = strdup(sample_name);
    session->rig_settings = weft_rig_settings_text(settings, request->seed, base_name(request->sample), crc32);
    session->camera = weft_rig_settings_camera(settings);
    session->camera_distance_mm = settings->camera_distance_mm;
    session->light_distance_mm = settings->light_distance_mm;
    session->bits = (int)settings->bits;
    session->black_level = (int)settings->black_level;
    session->target = weft_target_for_opening(settings->opening_mm);
    if (!session->folder || !session->rig || !session->sample || !session->rig_settings)
        return weft_fail_memory(error, "session", 0);
    return WEFT_OK;
}

static weft_code make(const weft_capture_request *request, weft_capture_setup *setup, weft_error *error)
{
    const weft_rig_settings *settings = &request->settings;
    WEFT_TRY(weft_virtual_sample_read(request->sample, settings, request->seed, &setup->sample, setup->warning, error));
    WEFT_TRY(describe(request, weft_virtual_sample_name(&setup->sample), &setup->session, error));
    return adopt_plan(request, &setup->session, error);
}

weft_code weft_capture_setup_make(const weft_capture_request *request, weft_capture_setup *setup, weft_error *error)
{
    *setup = (weft_capture_setup){.world = weft_virtual_world_of(&request->settings, request->seed)};
    weft_code code = make(request, setup, error);
    if (code != WEFT_OK)
        weft_capture_setup_free(setup);
    return code;
}

void weft_capture_setup_free(weft_capture_setup *setup)
{
    weft_session_free(&setup->session);
    weft_virtual_sample_free(&setup->sample);
}

uint64_t weft_photograph_bytes(const weft_session *session)
{
    const uint64_t header = 2048;
    uint64_t bits = (uint64_t)session->camera.width * (uint64_t)session->camera.height * 3 * (uint64_t)session->bits;
    return bits / 8 + header;
}
