/* The session of several cameras: a folder with a session for each, and cameras.json, which names them.
 *   cameras.json   {"weft_cameras": 1, "cameras": ["left", "right"]}
 *   left/...       the session of the camera "left", as any other (btf/session/session.h)
 *   right/... */
#ifndef WEFT_BTF_SESSION_CAMERA_LIST_H
#define WEFT_BTF_SESSION_CAMERA_LIST_H

#include "btf/session/session.h"

enum { WEFT_CAMERAS_MAX = 16, WEFT_CAMERA_NAME_SIZE = 32 };

extern const char weft_camera_list_file[]; /* "cameras.json" */

/* A name of one camera is the name of its folder. */
typedef struct weft_camera_list {
    int count; /* 0: a folder without the list, that is, of one camera without a name */
    char name[WEFT_CAMERAS_MAX][WEFT_CAMERA_NAME_SIZE];
} weft_camera_list;

/* Whether it can name a folder on any disk: 1 to 31 of a-z, A-Z, 0-9, '-' and '_'. Pure. */
bool weft_camera_name_is_sound(const char *name);

/* Reads FOLDER/cameras.json; where there is none, the list is empty. Errors: WEFT_BAD_INPUT naming the file. */
weft_code weft_camera_list_read(const char *folder, weft_camera_list *list, weft_error *error);

/* Writes it atomically into a folder that exists. Errors: WEFT_SYSTEM. */
weft_code weft_camera_list_write(const char *folder, const weft_camera_list *list, weft_error *error);

/* The file of a camera, of which `file` takes `size` bytes: `path` itself where `camera` is NULL; of one of several,
 * CAMERA.json in the folder `path`. Errors: WEFT_BAD_INPUT where `path` is no folder for several, or is one for one. */
weft_code weft_camera_file(const char *path, const char *camera, char *file, size_t size, weft_error *error);

/* Opens a session of one camera. The caller frees with weft_session_free. Errors: those of weft_session_open;
 * WEFT_BAD_INPUT for a folder of several, naming what belongs in its place. */
weft_code weft_camera_session_open(const char *folder, weft_session *session, weft_error *error);

/* Opens the session of each camera, or that of the folder itself where it has no list. *sessions [*count] is owned by
 * the caller: weft_camera_sessions_free. Errors: those of weft_camera_list_read and weft_session_open. */
weft_code weft_camera_sessions_open(const char *folder, weft_session **sessions, int *count, weft_error *error);
void weft_camera_sessions_free(weft_session *sessions, int count);

/* Whether the channels of all sessions are the same quantities: where every camera has its colours, or none has and all
 * are cameras of one model. Errors: WEFT_BAD_INPUT naming two that differ. Pure. */
weft_code weft_camera_sessions_agree(const weft_session *sessions, int count, weft_error *error);

#endif
