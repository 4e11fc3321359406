#include "player/window/panel.h"

#include "player/window/ui/ui_bridge.h"

#include <stdio.h>
#include <string.h>

/* A click on a folder goes there. */
static void folder_section(weft_application *a)
{
    const char *chosen = NULL;
    char label[NAME_MAX + 2];
    if (!a->folder.folder[0])
        weft_application_list(a, NULL);
    weft_ui_dim_text(a->folder.folder);
    for (int i = 0; i < a->folder.count; i++) {
        const char *path = a->folder.path[i];
        bool is_folder = i < a->folder.folder_count;
        snprintf(label, sizeof label, "%s%s", i == 0 ? ".." : strrchr(path, '/') + 1, is_folder ? "/" : "");
        if (!weft_ui_entry_chosen(label, path))
            continue;
        if (is_folder)
            chosen = path;
        else
            a->interaction.wants_file = path;
    }
    if (a->folder.has_more)
        weft_ui_dim_text("There are more.");
    if (weft_ui_button("Look again"))
        chosen = a->folder.folder;
    if (chosen)
        weft_application_list(a, chosen);
}

void weft_panel_show_files(weft_application *a)
{
    if (weft_ui_section("Files of the folder", false))
        folder_section(a);
}
