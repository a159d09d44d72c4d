/* folder.h - take away a folder that a test made. Needs _POSIX_C_SOURCE or _GNU_SOURCE. */
#ifndef FF_TEST_FOLDER_H
#define FF_TEST_FOLDER_H

#include <dirent.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

/* With everything in it, folders of folders included. 0, or -1. */
static inline int ff_remove_tree(const char *path)
{
    DIR *listing = opendir(path);
    if (!listing) return -1;
    int result = 0;
    for (struct dirent *entry = readdir(listing); entry; entry = readdir(listing)) {
        char inside[4096];
        if (strcmp(entry->d_name, ".") == 0 || strcmp(entry->d_name, "..") == 0) continue;
        int length = snprintf(inside, sizeof inside, "%s/%s", path, entry->d_name);
        if (length < 0 || (size_t)length >= sizeof inside)
            result = -1;
        else if (unlink(inside) != 0 && ff_remove_tree(inside) != 0)
            result = -1;
    }
    closedir(listing);
    return rmdir(path) == 0 ? result : -1;
}

#endif
