/* Which shots are taken together, and in which order. */
#ifndef WEFT_CAPTURE_SHOT_ORDER_H
#define WEFT_CAPTURE_SHOT_ORDER_H

#include "btf/session/camera_list.h"
#include "capture/rig.h"

/* Shot of each camera of the rig; -1: it takes none. */
typedef struct weft_synchronised_shot {
    int of_camera[WEFT_CAMERAS_MAX];
} weft_synchronised_shot;

typedef struct weft_shot_order {
    int count;
    weft_synchronised_shot *shot; /* [count] in the order of taking, owned */
    weft_stage_estimate stage;    /* all 0 where the stage does not know */
} weft_shot_order;

/* Puts the shots that `sessions` [camera_count] lack into synchronised shots: those of different cameras for which the
 * stage stands at the same place. Each is led by its first camera. Those of the first camera come first, in the order
 * that its stage chooses, then those of the second, and so on. The caller frees with weft_shot_order_free. Errors:
 * those of the stage; WEFT_SYSTEM. */
weft_code weft_shot_order_make(const weft_rig *rig, const weft_session *const *sessions, int camera_count,
                               weft_shot_order *order, weft_error *error);
void weft_shot_order_free(weft_shot_order *order);

#endif
