# Files that are made while building: the style of the pages, the font, the shaders.
set(made ${CMAKE_BINARY_DIR}/made)
# weft_embed_text(RESULT NAME PREFIX file...): the files as strings in the source made/NAME.c.
function(weft_embed_text result name prefix)
    set(source ${made}/${name}.c)
    add_custom_command(OUTPUT ${source}
        COMMAND ${CMAKE_COMMAND} -DOUTPUT=${source} -DPREFIX=${prefix} "-DINPUTS=${ARGN}" -P ${CMAKE_SOURCE_DIR}/cmake/embed_text.cmake
        DEPENDS ${ARGN} ${CMAKE_SOURCE_DIR}/cmake/embed_text.cmake VERBATIM)
    set(${result} ${source} PARENT_SCOPE)
endfunction()

weft_embed_text(page_source page weft_page_ ${CMAKE_SOURCE_DIR}/base/text/page/page.css ${CMAKE_SOURCE_DIR}/base/text/page/page.js)

find_file(WEFT_FONT Roboto-Regular.ttf
    PATHS /usr/share/fonts/truetype/roboto/unhinted/RobotoTTF /usr/share/fonts PATH_SUFFIXES truetype/roboto REQUIRED)
set(font_source ${made}/font_file.c)
add_custom_command(OUTPUT ${font_source}
    COMMAND ${CMAKE_COMMAND} -DINPUT=${WEFT_FONT} -DOUTPUT=${font_source} -DNAME=weft_font_file -P ${CMAKE_SOURCE_DIR}/cmake/embed_bytes.cmake
    DEPENDS ${WEFT_FONT} ${CMAKE_SOURCE_DIR}/cmake/embed_bytes.cmake VERBATIM)

file(GLOB shaders CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/player/draw/shaders/*.glsl)
foreach(model lafortune/lafortune components/components relief/relief woven/woven microcylinder/microcylinder weave/weave weave/weave_mean)
    list(APPEND shaders ${CMAKE_SOURCE_DIR}/reflectance/${model}.glsl)
endforeach()
weft_embed_text(shader_source shaders weft_glsl_ ${shaders})

# The modules, from the lowest to the highest: each uses only modules above it in this list. docs/architecture.md says what each is for.

weft_module(base
    FOLDERS base base/numeric)
weft_module(base/picture
    EXCEPT colour_tags_bridge.cpp exif_bridge.cpp exr_bridge.cpp image_bridge.cpp open_bridge.cpp raw_bridge.cpp tiff_sensitivity.c
    GENERATED ${font_source}
    USES base)
weft_module(base/text
    GENERATED ${page_source}
    USES base base/picture)
weft_module(btf/direction
    USES base)
weft_module(btf/dataset
    USES base base/text)
weft_module(btf/material
    FOLDERS btf/material btf
    USES base base/text btf/direction)
weft_module(btf/session
    USES base base/text btf/direction)
weft_module(reflectance
    FOLDERS reflectance/bard reflectance/components reflectance/lafortune reflectance/microcylinder reflectance/quadrature reflectance/relief reflectance/weave reflectance/woven
    USES base base/text btf/direction btf/material)
weft_module(geometry
    FOLDERS geometry/stitch geometry/yarn geometry/light geometry/acquisition geometry/drape
    USES base base/text btf/dataset btf/direction reflectance)
weft_module(capture
    FOLDERS capture capture/status
    USES base base/picture base/text btf/session)
weft_module(capture/virtual
    USES base base/text btf/session capture geometry reflectance)
weft_module(capture/synthetic
    USES base base/picture base/text btf/dataset btf/session capture/virtual)
weft_module(capture/print
    USES base base/picture btf/session)
weft_module(capture/laboratory
    EXCEPT video_bridge.cpp
    FOLDERS capture/laboratory capture/axes capture/motion capture/firmware capture/camera
    USES base base/picture base/text btf/direction btf/session capture)
weft_module(registration/pose
    USES base btf/session)
weft_module(capture/preflight
    USES base base/picture btf/session capture registration/pose)
weft_module(registration
    FOLDERS registration registration/outcome registration/report registration/resample registration/radiometry
    USES base base/picture base/text btf/dataset btf/session registration/pose)
weft_module(registration/lens
    USES base base/picture base/text btf/session registration/pose)
weft_module(registration/colour
    EXCEPT chart_bridge.cpp
    USES base base/picture base/text btf/session registration/pose)
weft_module(registration/axes
    USES base base/text btf/session registration registration/pose)
weft_module(registration/photographs
    FOLDERS registration/photographs registration/lamp
    USES base base/picture base/text btf/dataset btf/session registration registration/pose)
weft_module(import
    FOLDERS import import/bonn
    USES base base/picture base/text btf/dataset btf/direction btf/material)
weft_module(relief
    USES base base/picture base/text btf/dataset btf/direction reflectance)
weft_module(compress/fit
    FOLDERS compress/fit compress/texel compress/sparse compress/options
    USES base btf/dataset btf/direction btf/material)
weft_module(compress/run
    USES base btf/dataset btf/direction btf/material compress/fit)
weft_module(compress/components
    FOLDERS compress/components compress/kriging
    USES base btf/dataset btf/direction btf/material compress/fit compress/run reflectance)
weft_module(compress
    USES base base/text btf/dataset btf/material compress/components compress/fit compress/run)
weft_module(evaluate
    FOLDERS evaluate evaluate/error
    USES base base/picture base/text btf/dataset btf/direction btf/material reflectance)
weft_module(compress/hold_out
    USES base base/text btf/dataset btf/direction btf/material compress compress/fit compress/run evaluate reflectance)
weft_module(edit/tile
    FOLDERS edit/tile edit/blend
    USES base btf/dataset btf/direction btf/material reflectance)
weft_module(compress/weave_fit
    USES base btf/dataset btf/direction edit/tile reflectance)
weft_module(compress/bard
    USES base btf/dataset btf/direction evaluate reflectance)
weft_module(player/draw
    GENERATED ${shader_source}
    FOLDERS player/gl player/mesh player/scene player/texture player/raw player/draw
    USES base base/picture btf/dataset btf/direction btf/material reflectance)
weft_module(player/settings
    USES base base/picture base/text btf/dataset btf/direction btf/material player/draw reflectance)
weft_module(compare/pictures
    USES base base/picture player/draw player/settings)
weft_module(edit/prune
    USES base btf/direction btf/material compare/pictures player/draw player/settings)
weft_module(player/window
    FOLDERS player/window player/window/ui
    USES base base/picture btf/dataset btf/material player/draw player/settings reflectance)
weft_module(compare/truth
    USES base base/picture btf/dataset btf/material compare/pictures geometry player/draw)
weft_module(compare/report
    FOLDERS compare/report compare/report/page
    USES base base/picture base/text btf/dataset btf/direction btf/material compare/pictures compare/truth compress compress/weave_fit evaluate geometry player/draw reflectance)
weft_module(compare/rti
    USES base base/picture btf/dataset)
weft_module(compare/error_budget
    USES base base/text btf/dataset btf/material capture capture/virtual compress evaluate geometry registration)
weft_module(compare/tradeoff
    USES base base/picture base/text btf/dataset btf/direction btf/material compare/pictures compare/rti compress compress/bard compress/components compress/fit compress/hold_out compress/run compress/weave_fit evaluate import player/draw reflectance)
weft_module(inspect
    USES base base/picture base/text btf/dataset btf/direction btf/material btf/session capture compress/hold_out geometry player/draw reflectance)

# The link of a USB device's rule, named where one may not be opened.
set_source_files_properties(${CMAKE_SOURCE_DIR}/player/window/space_mouse.c PROPERTIES
    COMPILE_DEFINITIONS WEFT_UDEV_RULE="${CMAKE_SOURCE_DIR}/assets/udev/70-weft-space-mouse.rules")

weft_libraries()

weft_plugin(weft_image_library base/picture
    SOURCES colour_tags_bridge.cpp container.c exif_bridge.cpp exr_bridge.cpp image_bridge.cpp image.c open_bridge.cpp raw_bridge.cpp tiff_sensitivity.c USES PkgConfig::OIIO)
# Its headers take longer to read than all that the five bridges do with them.
target_precompile_headers(weft_image_library PRIVATE $<$<COMPILE_LANGUAGE:CXX>:<OpenImageIO/imageio.h$<ANGLE-R>>)
weft_plugin(weft_video_library capture/camera SOURCES video_bridge.cpp USES opencv_core opencv_videoio)
weft_plugin(weft_chart_library registration/colour SOURCES chart_bridge.cpp USES opencv_core opencv_imgproc opencv_mcc)

# LeakSanitizer stumbles over the thread-local storage of libraries that are loaded late: they are loaded at the start for it.
if(WEFT_SANITIZE STREQUAL "address")
    target_link_libraries(weft_static PUBLIC -Wl,--push-state,--no-as-needed PkgConfig::OIIO -Wl,--pop-state)
endif()
