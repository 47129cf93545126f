// SPDX-License-Identifier: Apache-2.0
// What the program that serves this page is asked for.

export interface Answer { status: number; headers: Headers; bytes: ArrayBuffer }

/** The program's whole answer. Throws what to tell the user where there is none, or one that is neither a success
 * nor of the status `expected`. */
export async function ask(path: string, request: RequestInit = {}, expected?: number): Promise<Answer> {
  let answer: Answer
  try {
    const response = await fetch(path, request)
    answer = { status: response.status, headers: response.headers, bytes: await response.arrayBuffer() }
  } catch {
    throw Error('The program does not answer: it has ended.')
  }
  if ((answer.status < 200 || answer.status > 299) && answer.status !== expected)
    throw Error(`The program answers ${answer.status} where it should know “${path}”.`)
  return answer
}
