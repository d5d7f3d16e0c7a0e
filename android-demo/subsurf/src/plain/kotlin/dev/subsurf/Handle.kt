package dev.subsurf

import java.util.concurrent.atomic.AtomicBoolean
import java.util.concurrent.atomic.AtomicInteger

/**
 * Handle of the library, which is released once it is closed and nobody uses it any more: a call that is under way on another
 * thread ends first.
 *
 * @property name What messages call it.
 * @property kept What has to live as long, such as the buffer that a file is read from.
 */
internal class Handle(
    private val name: String,
    private val pointer: Long,
    private val kept: Any? = null,
    private val release: (Long) -> Unit,
) : AutoCloseable {
    /** Users at this moment, the owner among them; 0 once it is released, [ALONE] while one has it for itself. */
    private val users = AtomicInteger(1)
    private val isClosed = AtomicBoolean()

    /** Whether the owner is no user any more: of two that find the handle closed, one takes it from the users. */
    private val isLeft = AtomicBoolean()

    /** Calls with the pointer, which stays for the call. */
    inline fun <T> call(work: (Long) -> T): T {
        enter()
        try {
            return work(pointer)
        } finally {
            leave()
        }
    }

    /** Calls with the pointer while nobody else uses it. */
    fun <T> callAlone(work: (Long) -> T): T {
        expectOpen(!isClosed.get())
        check(users.compareAndSet(1, ALONE)) { "$name is in use on another thread" }
        try {
            return work(pointer)
        } finally {
            users.set(1)
            if (isClosed.get()) leaveAsOwner()
        }
    }

    fun enter() {
        while (true) {
            val count = users.get()
            check(count != ALONE) { "$name is in use on another thread" }
            expectOpen(count > 0 && !isClosed.get())
            if (users.compareAndSet(count, count + 1)) return
        }
    }

    fun leave() {
        if (users.decrementAndGet() == 0) release(pointer)
    }

    override fun close() {
        if (isClosed.compareAndSet(false, true) && users.get() != ALONE) leaveAsOwner()
    }

    private fun leaveAsOwner() {
        if (isLeft.compareAndSet(false, true)) leave()
    }

    private fun expectOpen(isOpen: Boolean) = check(isOpen) { "$name is closed" }

    companion object {
        private const val ALONE = -1
    }
}
