/* Calls of the system that decide what a power cut or a kill leaves on the disk. The linker takes fdatasync, fsync,
 * rename and pwrite through here (tests/capture/CMakeLists.txt). */
#ifndef WEFT_TESTS_CAPTURE_DISK_CALLS_H
#define WEFT_TESTS_CAPTURE_DISK_CALLS_H

/* Of a session in a folder called "session": P the photograph is synced, R renamed, L its journal line appended; v the
 * folder of a view is synced, s that of the session, J the journal. '-': any other call. Called before it; returns 0,
 * or the errno that it is to fail with. May be called from several threads. */
typedef int disk_call_visitor(char event);

/* NULL: nobody listens. */
extern disk_call_visitor *disk_call_visit;

#endif
