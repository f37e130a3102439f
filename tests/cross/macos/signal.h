/* signals of POSIX. macOS has no sigtimedwait. */
#ifndef MACOS_STUB_SIGNAL_H
#define MACOS_STUB_SIGNAL_H

#define SIGPIPE 13
#define SIG_BLOCK 1
#define SIG_UNBLOCK 2

typedef unsigned int sigset_t;

int pthread_sigmask(int how, const sigset_t *set, sigset_t *before);
int sigaddset(sigset_t *set, int signal);
int sigemptyset(sigset_t *set);
int sigismember(const sigset_t *set, int signal);
int sigpending(sigset_t *set);
int sigwait(const sigset_t *set, int *signal);

#endif /* MACOS_STUB_SIGNAL_H */
