/* Changing the weave that a player shows, one parameter at a time. The weave is the file's, until it is changed. */
#ifndef WEFT_PLAYER_WINDOW_WEAVE_EDIT_H
#define WEFT_PLAYER_WINDOW_WEAVE_EDIT_H

#include "player/draw/player.h"
#include "player/settings/loader.h"

typedef struct weft_weave_edit {
    weft_weave weave;             /* no yarns: there is none to edit */
    int yarn;                     /* index of the one that is edited */
    bool alike;                   /* with it all that had the same segment */
    int reads;                    /* how many files have been read: which of them `weave` is of */
    bool is_changed;              /* not as its file has it */
    bool is_unsaved;              /* no file has it */
    long revision;                /* weft_player_weave_revision of the weave */
    bool is_pending;              /* what follows from the last change is not shown yet, or not to its last digits */
    bool is_stale;                /* nobody derives yet what follows from the last change */
    struct weft_derived *derived; /* what follows from changes; NULL: no weave */
} weft_weave_edit;

/* A parameter of a segment: where it lies in a weft_yarn, and what the slider spans; angles are shown in degrees. */
typedef struct weft_weave_parameter_range {
    const char *name;
    size_t offset;
    double low, high;
    bool is_angle, logarithmic;
} weft_weave_parameter_range;

enum { WEFT_WEAVE_RANGES = 9 };
extern const weft_weave_parameter_range weft_weave_ranges[WEFT_WEAVE_RANGES];

void weft_weave_edit_free(weft_weave_edit *edit);

/* Reads the file at `path` (NULL: none) unless the player shows what `edit` has: what was changed is lost when another
 * weave is shown. Reads it once. Errors: those of weft_weave_read; there is nothing to edit then. */
weft_code weft_weave_edit_follow(weft_weave_edit *edit, const weft_player *player, const char *path, weft_error *error);

/* The chosen yarn's value; radians for angles. Pure. */
double weft_weave_edit_get(const weft_weave_edit *edit, const weft_weave_parameter_range *range);

/* Change the chosen yarn and, with `alike`, those like it; weft_weave_edit_ask and weft_weave_edit_poll make the player
 * show that. */
void weft_weave_edit_set(weft_weave_edit *edit, const weft_weave_parameter_range *range, double value);
void weft_weave_edit_set_colours(weft_weave_edit *edit, weft_rgb kd, weft_rgb ks);

/* Changes the noise of the weave: `fineness`, `period` and the amplitudes as in weft_weave. */
void weft_weave_edit_set_noise(weft_weave_edit *edit, double fineness, double period, const double amplitude_deg[4]);

/* Asks for what follows from the segments, which is derived in the background: first with an estimated specular scale
 * (weft_weave_specular_scale_batch, as its ratio to the one before), and once nothing has been asked for a while, with
 * the exact one. Errors: WEFT_SYSTEM. */
weft_code weft_weave_edit_ask(weft_weave_edit *edit, weft_error *error);

/* Shows what has been derived, if anything has, laid on the material as before; *shown: the picture is out
 * of date. Unless the player shows another weave by now. Errors: those of weft_player_set_weave_texels. */
weft_code weft_weave_edit_poll(weft_weave_edit *edit, weft_player *player, bool *shown, weft_error *error);

/* Writes weft-001.wv or the first number that is free into the current folder; `path` receives its name. Errors: those
 * of weft_weave_write. */
weft_code weft_weave_edit_save(weft_weave_edit *edit, char path[32], weft_error *error);

#endif
