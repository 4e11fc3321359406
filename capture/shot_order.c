#include "capture/shot_order.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A shot that is missing, and where the stage stands for it. */
typedef struct missing_shot {
    long long place[WEFT_PLACE_NUMBERS]; /* in millionths */
    int camera, shot;
} missing_shot;

typedef struct missing_shots {
    int count;
    missing_shot *shot; /* [count] */
} missing_shots;

/* ---- What is missing ---- */

static weft_code note_shot(const weft_rig *rig, const weft_session *session, int camera, int shot,
                           missing_shots *missing, weft_error *error)
{
    missing_shot *noted = &missing->shot[missing->count++];
    weft_place place = {0};
    if (rig->first)
        WEFT_TRY(rig->stage.place(rig->stage.device, &session->shot[shot], &place, error));
    *noted = (missing_shot){.camera = camera, .shot = shot};
    for (int i = 0; i < WEFT_PLACE_NUMBERS; i++)
        noted->place[i] = llround(place.at[i] * 1e6);
    return WEFT_OK;
}

static weft_code note_all(const weft_rig *rig, const weft_session *const *sessions, int camera_count,
                          missing_shots *missing, weft_error *error)
{
    for (int camera = 0; camera < camera_count; camera++, rig = rig->next) {
        for (int shot = 0; shot < sessions[camera]->shot_count; shot++) {
            if (!sessions[camera]->record[shot].taken)
                WEFT_TRY(note_shot(rig, sessions[camera], camera, shot, missing, error));
        }
    }
    return WEFT_OK;
}

static int compare_places(const missing_shot *a, const missing_shot *b)
{
    for (int i = 0; i < WEFT_PLACE_NUMBERS; i++) {
        if (a->place[i] != b->place[i])
            return a->place[i] < b->place[i] ? -1 : 1;
    }
    return 0;
}

static int compare_missing(const void *a, const void *b)
{
    const missing_shot *p = a, *q = b;
    int places = compare_places(p, q), cameras = p->camera - q->camera;
    return places ? places : cameras ? cameras : p->shot - q->shot;
}

/* ---- Synchronised shots ---- */

static weft_synchronised_shot led_by(const missing_shot *leader)
{
    weft_synchronised_shot together;
    for (int i = 0; i < WEFT_CAMERAS_MAX; i++)
        together.of_camera[i] = -1;
    together.of_camera[leader->camera] = leader->shot;
    return together;
}

/* From shots sorted by place: those of one place go together, but two of one camera do not. */
static void group(const missing_shots *missing, bool several, weft_shot_order *order)
{
    for (int i = 0; i < missing->count; i++) {
        const missing_shot *one = &missing->shot[i], *before = one - 1;
        bool joins = several && i > 0 && compare_places(before, one) == 0 && before->camera != one->camera;
        if (joins)
            order->shot[order->count - 1].of_camera[one->camera] = one->shot;
        else
            order->shot[order->count++] = led_by(one);
    }
}

static int leader_of(const weft_synchronised_shot *together)
{
    int camera = 0;
    while (together->of_camera[camera] < 0)
        camera++;
    return camera;
}

static int compare_shots(const void *a, const void *b)
{
    const weft_synchronised_shot *p = a, *q = b;
    int first = leader_of(p), second = leader_of(q);
    return first != second ? first - second : p->of_camera[first] - q->of_camera[second];
}

/* ---- Their order ---- */

/* Where the synchronised shot of a shot lies among those of its leader, which are sorted by shot. */
static const weft_synchronised_shot *find_shot(const weft_synchronised_shot *together, int count, int camera, int shot)
{
    int low = 0;
    for (int high = count; low < high;) {
        int middle = (low + high) / 2;
        if (together[middle].of_camera[camera] < shot)
            low = middle + 1;
        else
            high = middle;
    }
    return &together[low];
}

/* `numbers` [count] and `sorted` [count] are for use here. */
static weft_code order_leader(const weft_rig_stage *stage, const weft_session *session, int camera,
                              weft_synchronised_shot *together, int count, int *numbers, weft_synchronised_shot *sorted,
                              weft_stage_estimate *sum, weft_error *error)
{
    weft_stage_estimate estimate = {0};
    for (int i = 0; i < count; i++)
        numbers[i] = together[i].of_camera[camera];
    if (!stage->order || count == 0)
        return WEFT_OK;
    WEFT_TRY(stage->order(stage->device, session->shot, count, numbers, &estimate, error));
    for (int i = 0; i < count; i++)
        sorted[i] = *find_shot(together, count, camera, numbers[i]);
    memcpy(together, sorted, (size_t)count * sizeof *together);
    sum->seconds += estimate.seconds;
    sum->moves += estimate.moves;
    return WEFT_OK;
}

static weft_code order_all(const weft_rig *rig, const weft_session *const *sessions, int camera_count,
                           weft_shot_order *order, int *numbers, weft_synchronised_shot *sorted, weft_error *error)
{
    int begin = 0;
    for (int camera = 0; camera < camera_count; camera++, rig = rig->next) {
        int end = begin;
        while (end < order->count && leader_of(&order->shot[end]) == camera)
            end++;
        WEFT_TRY(order_leader(&rig->stage, sessions[camera], camera, order->shot + begin, end - begin, numbers, sorted,
                              &order->stage, error));
        begin = end;
    }
    return WEFT_OK;
}

static weft_code make(const weft_rig *rig, const weft_session *const *sessions, int camera_count,
                      missing_shots *missing, weft_shot_order *order, weft_error *error)
{
    WEFT_TRY(note_all(rig, sessions, camera_count, missing, error));
    qsort(missing->shot, (size_t)missing->count, sizeof *missing->shot, compare_missing);
    group(missing, camera_count > 1, order);
    qsort(order->shot, (size_t)order->count, sizeof *order->shot, compare_shots);
    size_t count = (size_t)order->count + 1;
    int *numbers = malloc(count * sizeof *numbers);
    weft_synchronised_shot *sorted = malloc(count * sizeof *sorted);
    weft_code code = numbers && sorted ? order_all(rig, sessions, camera_count, order, numbers, sorted, error)
                                       : weft_fail_memory(error, "plan", count * (sizeof *numbers + sizeof *sorted));
    free(numbers);
    free(sorted);
    return code;
}

weft_code weft_shot_order_make(const weft_rig *rig, const weft_session *const *sessions, int camera_count,
                               weft_shot_order *order, weft_error *error)
{
    size_t most = 1;
    for (int camera = 0; camera < camera_count; camera++)
        most += (size_t)sessions[camera]->shot_count;
    missing_shots missing = {0, malloc(most * sizeof *missing.shot)};
    *order = (weft_shot_order){.shot = malloc(most * sizeof *order->shot)};
    weft_code code = missing.shot && order->shot
                         ? make(rig, sessions, camera_count, &missing, order, error)
                         : weft_fail_memory(error, "plan", most * (sizeof *missing.shot + sizeof *order->shot));
    free(missing.shot);
    if (code != WEFT_OK)
        weft_shot_order_free(order);
    return code;
}

void weft_shot_order_free(weft_shot_order *order)
{
    free(order->shot);
    *order = (weft_shot_order){0};
}
