#include "compare/error_budget/error_budget.h"

#include "base/atomic_file.h"
#include "capture/capture.h"
#include "compress/compress.h"
#include "registration/registration.h"

#include <ftw.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

/* ---- Files ---- */

static int remove_one(const char *path, const struct stat *status, int kind, struct FTW *place)
{
    (void)status;
    (void)kind;
    (void)place;
    return remove(path);
}

/* Never through a link. */
static void remove_folder(const char *path)
{
    enum { OPEN_FOLDERS = 16 };
    nftw(path, remove_one, OPEN_FOLDERS, FTW_DEPTH | FTW_PHYS);
}

void weft_chain_remove(const weft_chain *chain)
{
    remove_folder(chain->session);
    unlink(chain->registered);
    unlink(chain->fitted);
    unlink(chain->stored);
}

/* A name that is cut off is none: it would be removed in the end. */
static weft_code name_file(const char *folder, const char *name, char path[PATH_MAX], weft_error *error)
{
    if (snprintf(path, PATH_MAX, "%s/%s", folder, name) < PATH_MAX)
        return WEFT_OK;
    path[0] = '\0';
    return weft_fail(error, WEFT_BAD_USAGE, "'%s' is too long a name", folder);
}

static weft_code name_files(const char *folder, weft_chain *chain, weft_error *error)
{
    WEFT_TRY(name_file(folder, ".sources.session", chain->session, error));
    WEFT_TRY(name_file(folder, ".sources.btf.h5", chain->registered, error));
    WEFT_TRY(name_file(folder, ".sources.fitted.weft", chain->fitted, error));
    return name_file(folder, ".sources.stored.weft", chain->stored, error);
}

/* ---- Stages ---- */

static weft_code photograph(const weft_chain_request *request, weft_virtual_rig *rig, const weft_progress *progress,
                            weft_chain *chain, weft_error *error)
{
    const weft_capture_request taking = {.folder = chain->session, .plan = request->plan};
    weft_capture capture;
    WEFT_TRY(weft_capture_begin(&taking, &rig->rig, progress, &capture, error));
    weft_code code = weft_capture_take(&capture, NULL, progress, error);
    weft_capture_end(&capture);
    return code;
}

static weft_code register_photographs(const weft_chain_request *request, const weft_progress *progress,
                                      weft_chain *chain, weft_error *error)
{
    weft_session session;
    weft_registration registration;
    WEFT_TRY(weft_session_open(chain->session, &session, error));
    weft_registration_settings settings = weft_registration_defaults(&session);
    settings.width = settings.height = request->size;
    weft_code code = weft_register_session(&session, chain->registered, &settings, progress, &registration, error);
    if (code == WEFT_OK) {
        chain->photograph_count = session.shot_count;
        chain->registered_count = registration.image_count;
        weft_registration_free(&registration);
    }
    weft_session_free(&session);
    return code;
}

static weft_code fit(weft_dataset *dataset, const weft_compress_options *options, const char *path,
                     const weft_progress *progress, int *component_count, weft_error *error)
{
    weft_material material;
    WEFT_TRY(weft_compress(dataset, options, progress, &material, NULL, error));
    *component_count = material.components ? material.components->component_count : 0;
    weft_code code = weft_material_write(path, &material, error);
    weft_material_free(&material);
    return code;
}

static weft_code fit_both(const weft_chain_request *request, weft_dataset *dataset, const weft_progress *progress,
                          weft_chain *chain, weft_error *error)
{
    weft_compress_options options = weft_compress_default_options();
    options.component_count = request->component_count;
    options.levels = false;
    WEFT_TRY(fit(dataset, &options, chain->stored, progress, &chain->component_count, error));
    if (chain->component_count == 0)
        return weft_fail(error, WEFT_BAD_USAGE,
                         "the plan has too few photographs for components: say how many with "
                         "--components");
    int finer_count;
    options.component_count = chain->component_count;
    options.finer = true;
    return fit(dataset, &options, chain->fitted, progress, &finer_count, error);
}

static weft_code compress(const weft_chain_request *request, const weft_progress *progress, weft_chain *chain,
                          weft_error *error)
{
    weft_dataset *dataset;
    WEFT_TRY(weft_dataset_open(chain->registered, &dataset, error));
    weft_code code = fit_both(request, dataset, progress, chain, error);
    weft_dataset_close(dataset);
    return code;
}

weft_code weft_chain_make(const weft_chain_request *request, weft_virtual_rig *rig, const char *folder,
                          const weft_progress *progress, weft_chain *chain, weft_error *error)
{
    *chain = (weft_chain){0};
    WEFT_TRY(name_files(folder, chain, error));
    weft_chain_remove(chain); /* what a process left that died here */
    WEFT_TRY(photograph(request, rig, progress, chain, error));
    WEFT_TRY(register_photographs(request, progress, chain, error));
    remove_folder(chain->session);
    return compress(request, progress, chain, error);
}
