/* Opens a part of a file by its descriptor, describes it and reads all of its planes, and looks at the memory that this took: pages of the
 * file, and none of the process's own. */
#define _POSIX_C_SOURCE 200809L
#include "expect.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Kilobytes of a line of /proc/self/status. */
static long status_kb(const char *name) {
    FILE *stream = fopen("/proc/self/status", "r");
    char line[256];
    long kb = -1;
    EXPECT(stream != NULL);
    while (fgets(line, sizeof line, stream) != NULL) {
        if (strncmp(line, name, strlen(name)) == 0) {
            kb = strtol(line + strlen(name), NULL, 10);
        }
    }
    fclose(stream);
    return kb;
}

/* Kilobytes of the mapping that has an address, how many of them are copies, and whether it is one of a file. */
typedef struct Pages {
    long resident_kb, own_kb;
    int is_of_file;
} Pages;

static Pages pages_at(const void *address, const char *path) {
    FILE *stream = fopen("/proc/self/smaps", "r");
    char line[4352];
    Pages pages = {0, 0, 0};
    int is_here = 0;
    EXPECT(stream != NULL);
    while (fgets(line, sizeof line, stream) != NULL) {
        unsigned long first, end;
        if (sscanf(line, "%lx-%lx ", &first, &end) == 2) {
            is_here = first <= (unsigned long)address && (unsigned long)address < end;
            pages.is_of_file |= is_here && strstr(line, path) != NULL;
        } else if (is_here) {
            (void)sscanf(line, "Rss: %ld", &pages.resident_kb);
            (void)sscanf(line, "Anonymous: %ld", &pages.own_kb);
        }
    }
    fclose(stream);
    return pages;
}

int main(int argc, char **argv) {
    EXPECT(argc == 4);
    const char *path = argv[1];
    uint64_t offset = strtoul(argv[2], NULL, 10), length = strtoul(argv[3], NULL, 10);
    long kb = (long)(length / 1024), own_kb = status_kb("RssAnon:"), file_kb = status_kb("RssFile:");
    SubsurfFile *file = NULL;
    SubsurfBssrdfInfo info;
    SubsurfPlane plane;
    const void *first;
    size_t first_length;
    unsigned long sum = 0;
    int fd = open(path, O_RDONLY);
    info.struct_size = sizeof info;
    plane.struct_size = sizeof plane;
    EXPECT(own_kb >= 0 && file_kb >= 0);
    OK(subsurf_file_open_fd(fd, offset, length, &file));
    close(fd);
    OK(subsurf_bssrdf_info(file, &info));
    OK(subsurf_file_bytes(file, &first, &first_length));
    EXPECT(first_length == length);
    for (uint32_t k = 0; subsurf_bssrdf_plane(file, k, &plane) == SUBSURF_STATUS_OK; k++) {
        const unsigned char *bytes = (const unsigned char *)plane.data;
        /* Planes are handed out where they lie. */
        EXPECT((const unsigned char *)first <= bytes && bytes + plane.bytes <= (const unsigned char *)first + length);
        for (size_t at = 0; at < plane.bytes; at++) {
            sum += bytes[at];
        }
    }
    Pages pages = pages_at(first, path);
    printf("%ld kB of file: own pages grew by %ld kB, pages of files by %ld kB; the mapping has %ld kB, own %ld kB (sum %lu)\n", kb,
           status_kb("RssAnon:") - own_kb, status_kb("RssFile:") - file_kb, pages.resident_kb, pages.own_kb, sum);
    EXPECT(pages.is_of_file && pages.resident_kb >= kb && pages.own_kb == 0);
    EXPECT(status_kb("RssFile:") - file_kb >= kb);
    EXPECT(status_kb("RssAnon:") - own_kb < kb / 20);
    subsurf_file_close(file);
    EXPECT(status_kb("RssFile:") - file_kb < kb / 20);
    return 0;
}
