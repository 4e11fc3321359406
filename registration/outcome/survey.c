#include "registration/outcome/outcome.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const double same_direction_rad = 1e-7;

static int find_view(const weft_survey *survey, weft_angles view)
{
    /* Plans run through the lights of a view, or through the views of a light: the last views are the likeliest. */
    for (int i = survey->view_count - 1; i >= 0; i--) {
        if (fabs(survey->view[i].theta_rad - view.theta_rad) < same_direction_rad &&
            fabs(survey->view[i].phi_rad - view.phi_rad) < same_direction_rad)
            return i;
    }
    return -1;
}

static void list_views(const weft_session *session, weft_survey *survey)
{
    for (int shot = 0; shot < session->shot_count; shot++) {
        int view = find_view(survey, session->shot[shot].view);
        if (view < 0) {
            view = survey->view_count++;
            survey->view[view] = session->shot[shot].view;
        }
        survey->view_of_shot[shot] = view;
    }
}

typedef struct shot_key {
    int view, viewpoint, shot;
} shot_key;

static int compare_keys(const void *first, const void *second)
{
    const shot_key *a = first, *b = second;
    if (a->view != b->view)
        return a->view < b->view ? -1 : 1;
    if (a->viewpoint != b->viewpoint)
        return a->viewpoint < b->viewpoint ? -1 : 1;
    return a->shot < b->shot ? -1 : a->shot > b->shot;
}

static void list_viewpoints(const shot_key *key, int count, weft_survey *survey)
{
    for (int i = 0; i < count; i++) {
        survey->order[i] = key[i].shot;
        if (i == 0 || key[i].view != key[i - 1].view || key[i].viewpoint != key[i - 1].viewpoint)
            survey->viewpoint[survey->viewpoint_count++] =
                (weft_viewpoint){key[i].view, key[i].viewpoint, 0, survey->order + i};
        survey->viewpoint[survey->viewpoint_count - 1].count++;
    }
}

weft_code weft_survey_make(const weft_session *session, weft_survey *survey, weft_error *error)
{
    size_t shots = session->shot_count > 0 ? (size_t)session->shot_count : 1;
    *survey = (weft_survey){.view = malloc(shots * sizeof *survey->view),
                            .view_of_shot = malloc(shots * sizeof *survey->view_of_shot),
                            .viewpoint = malloc(shots * sizeof *survey->viewpoint),
                            .order = malloc(shots * sizeof *survey->order)};
    shot_key *key = malloc(shots * sizeof *key);
    weft_code code = WEFT_OK;
    int taken = 0;
    if (!survey->view || !survey->view_of_shot || !survey->viewpoint || !survey->order || !key) {
        code = weft_fail_memory(error, "the survey of a session", shots * 64);
        goto done;
    }
    list_views(session, survey);
    for (int shot = 0; shot < session->shot_count; shot++) {
        if (session->record[shot].taken)
            key[taken++] = (shot_key){survey->view_of_shot[shot], session->record[shot].viewpoint, shot};
    }
    survey->untaken = session->shot_count - taken;
    if (taken == 0) {
        code = weft_fail(error, WEFT_BAD_INPUT, "'%s' holds no photograph: none of its %d shots was taken",
                         session->folder, session->shot_count);
        goto done;
    }
    qsort(key, (size_t)taken, sizeof *key, compare_keys);
    list_viewpoints(key, taken, survey);
done:
    free(key);
    if (code != WEFT_OK)
        weft_survey_free(survey);
    return code;
}

void weft_survey_free(weft_survey *survey)
{
    free(survey->view);
    free(survey->view_of_shot);
    free(survey->viewpoint);
    free(survey->order);
    *survey = (weft_survey){0};
}

weft_view_name weft_view_name_of(weft_angles view)
{
    weft_view_name name;
    long theta_deg = lround(weft_deg_of_rad(view.theta_rad)), phi_deg = lround(weft_deg_of_rad(view.phi_rad));
    snprintf(name.text, sizeof name.text, "tv%03d_pv%03d", (int)theta_deg % 1000, (int)phi_deg % 1000);
    return name;
}
