#include "shared_source.h"

#include <stddef.h>

bool shared_source_init(struct shared_source *s,
                        SluiceResult (*open)(void *user_data, SluiceImageSource **source),
                        void *user_data)
{
    *s = (struct shared_source){.open = open, .user_data = user_data};
    return pthread_mutex_init(&s->mutex, NULL) == 0;
}

void shared_source_finish(struct shared_source *s)
{
    if (s->open)
        pthread_mutex_destroy(&s->mutex);
    s->open = NULL;
}

SluiceResult shared_source_open(void *shared, SluiceImageSource **source)
{
    struct shared_source *s = shared;
    SluiceResult result = SLUICE_SUCCESS;
    pthread_mutex_lock(&s->mutex);
    if (s->user_count == 0)
        result = s->open(s->user_data, &s->source);
    if (result == SLUICE_SUCCESS) {
        s->user_count++;
        *source = s->source;
    }
    pthread_mutex_unlock(&s->mutex);
    return result;
}

void shared_source_close(void *shared, SluiceImageSource *source)
{
    struct shared_source *s = shared;
    pthread_mutex_lock(&s->mutex);
    const bool is_last = --s->user_count == 0;
    if (is_last)
        s->source = NULL;
    pthread_mutex_unlock(&s->mutex);
    if (is_last)
        sluiceDestroyImageSource(source);
}
