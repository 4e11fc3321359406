/* One file of a scene on its way from the disk to the player. */
#ifndef WEFT_CLI_SCENE_PART_H
#define WEFT_CLI_SCENE_PART_H

#include "cli/scene_options.h"
#include "player/window/loader.h"

typedef enum scene_slot {
    SCENE_MATERIAL,
    SCENE_MESH,
    SCENE_WEAVE,
    SCENE_ENVIRONMENT,
    SCENE_DATASET,
    SCENE_SLOT_COUNT
} scene_slot;

/* What parts change as they are read and shown. */
typedef struct scene_stage {
    scene_options *options;            /* its settings name what is shown */
    weft_player *player;               /* must be set before a dataset is started, and before anything is shown */
    char *metadata;                    /* of the material read last; the reader's alone */
    double width_mm[SCENE_SLOT_COUNT]; /* of a model; 0: unknown */
    weft_mesh mesh;                    /* that is shown, without its vertices */
    bool by_user;                      /* of the part shown last: it was asked for while playing */
    scene_slot slot;                   /* of the part shown last */
    char note[WEFT_MESSAGE_SIZE];      /* what the user should know of it */
} scene_stage;

void scene_stage_free(scene_stage *stage);

/* The settings' name of what is shown in a slot. */
char **scene_stage_path(scene_stage *stage, scene_slot slot);

/* Starts to read a file into a slot. Errors: WEFT_SYSTEM. */
weft_code scene_part_start(scene_stage *stage, weft_loader *loader, scene_slot slot, const char *path, bool by_user,
                           weft_error *error);

#endif
