#include "crew.h"

#include <pthread.h>
#include <stdlib.h>

struct member {
    crew_work work;
    void *user_data;
    uint32_t index;
    bool has_thread, done;
    pthread_t thread;
};

static void *work(void *user_data)
{
    struct member *member = user_data;
    member->done = member->work(member->user_data, member->index);
    return NULL;
}

bool crew_run(uint32_t count, crew_work function, void *user_data)
{
    struct member *members = calloc(count, sizeof *members);
    bool done = function != NULL;
    for (uint32_t i = 0; i < count && !members;
         i++) /* out of memory: run the members one after the other */
        done = function(user_data, i) && done;
    for (uint32_t i = 0; i < count && members; i++) {
        members[i] = (struct member){.work = function, .user_data = user_data, .index = i};
        members[i].has_thread =
            i > 0 && pthread_create(&members[i].thread, NULL, work, &members[i]) == 0;
    }
    for (uint32_t i = 0; i < count && members; i++) {
        if (members[i].has_thread)
            pthread_join(members[i].thread, NULL);
        else
            work(&members[i]);
        done = done && members[i].done;
    }
    free(members);
    return done;
}
