/* One file of a scene on its way from the disk to the player. */
#ifndef WEFT_PLAYER_SETTINGS_SCENE_PART_H
#define WEFT_PLAYER_SETTINGS_SCENE_PART_H

#include "btf/material/held_out.h"
#include "player/settings/loader.h"
#include "player/settings/settings.h"
#include "reflectance/weave/weave.h"

typedef enum weft_scene_slot {
    WEFT_SLOT_MATERIAL,
    WEFT_SLOT_MESH,
    WEFT_SLOT_WEAVE,
    WEFT_SLOT_ENVIRONMENT,
    WEFT_SLOT_DATASET,
    WEFT_SLOT_COUNT
} weft_scene_slot;

/* How a weave lies where it is shown. */
typedef struct weft_woven {
    weft_weave_layout on_material, alone;
    double tile_width_mm;
} weft_woven;

/* What parts change as they are read and shown. */
typedef struct weft_scene_stage {
    weft_settings *settings;            /* name what is shown */
    weft_player *player;                /* must be set before a dataset is started, and before anything is shown */
    char *metadata;                     /* of the material read last; the reader's alone */
    double width_mm[WEFT_SLOT_COUNT];   /* of a measured model; 0: unknown */
    bool is_measured;                   /* the material that is shown, on directions that were held out */
    weft_hold_out held_out;             /* of it */
    weft_woven woven;                   /* of the weave that is shown */
    double proportion[WEFT_SLOT_COUNT]; /* height over width of a measured model; 0: unknown */
    weft_mesh mesh;                     /* that is shown, without its vertices */
    double plane_proportion;            /* of it, where it is the plane */
    bool by_user;                       /* of the part shown last: it was asked for while playing */
    weft_scene_slot slot;               /* of the part shown last */
    char note[WEFT_MESSAGE_SIZE];       /* what the user should know of it */
} weft_scene_stage;

void weft_scene_stage_free(weft_scene_stage *stage);

/* The settings' name of what is shown in a slot. */
char **weft_scene_stage_path(weft_scene_stage *stage, weft_scene_slot slot);

/* Starts to read a file into a slot. Errors: WEFT_SYSTEM. */
weft_code weft_scene_part_start(weft_scene_stage *stage, weft_loader *loader, weft_scene_slot slot, const char *path,
                                bool by_user, weft_error *error);

#endif
