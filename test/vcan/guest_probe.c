/* Programs for the tests of with-vcan, in one: Python would take a guest longer to start.
 *
 *   guest_probe numbers          calculates in two processes that wait for each other
 *   guest_probe compute          uses the processor until 0.2 s have passed
 *   guest_probe gaps FOLDER      looks at its clock until FOLDER/stopped exists; 1: it missed more
 * than a second
 */
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

static double now(void) {
  struct timespec time;
  clock_gettime(CLOCK_MONOTONIC, &time);
  return (double)time.tv_sec + (double)time.tv_nsec / 1e9;
}

/* A system call of one byte while `kept` is in a register of the processor, where a wrong register
 * would change it. */
static double transfer(long call, int end, double kept) {
  char byte = 'x';
  long result = call;
#if defined __x86_64__
  __asm__ volatile("syscall"
                   : "+a"(result), "+x"(kept)
                   : "D"((long)end), "S"(&byte), "d"(1L)
                   : "rcx", "r11", "memory");
#else
  result = syscall(call, end, &byte, 1L);
#endif
  if (result != 1) exit(2);
  return kept;
}

/* Floating-point numbers in two processes: their registers are saved and set again and again. */
static int numbers(void) {
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0) return 2;
  const pid_t child = fork();
  const double number = child == 0 ? 0.5 : 0.25;
  const int end = ends[child == 0];
  double total = 0;
  for (int turn = 0; turn < 200; turn++) {
    total = transfer(SYS_write, end, total + number);
    total = transfer(SYS_read, end, total);
  }
  if (child == 0) _exit(total == 200 * number ? 0 : 1);
  int status = 1;
  waitpid(child, &status, 0);
  const int right = total == 200 * number && status == 0;
  puts(right ? "numbers are right" : "numbers are wrong");
  return !right;
}

static int compute(void) {
  const double end = now() + 0.2;
  while (now() < end) {
  }
  return 0;
}

static int gaps(const char* folder) {
  char begun[4096], stopped[4096];
  snprintf(begun, sizeof begun, "%s/begun", folder);
  snprintf(stopped, sizeof stopped, "%s/stopped", folder);
  close(open(begun, O_WRONLY | O_CREAT, 0644));
  double longest = 0, last = now();
  while (access(stopped, F_OK) != 0) {
    nanosleep(&(struct timespec){0, 1000000}, NULL);
    const double time = now();
    if (time - last > longest) longest = time - last;
    last = time;
  }
  printf("the longest gap has %.0f ms\n", longest * 1000);
  return longest > 1;
}

int main(int count, char** words) {
  if (count == 2 && strcmp(words[1], "numbers") == 0) return numbers();
  if (count == 2 && strcmp(words[1], "compute") == 0) return compute();
  if (count == 3 && strcmp(words[1], "gaps") == 0) return gaps(words[2]);
  return 2;
}
