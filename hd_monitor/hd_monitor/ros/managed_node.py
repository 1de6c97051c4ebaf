"""Common base of the project's managed nodes: they start by themselves, refuse bad parameters and end cleanly."""

import signal
import traceback
from collections.abc import Callable
from functools import wraps
from typing import Any

import rclpy
from rclpy.clock import Clock, ClockType
from rclpy.exceptions import ParameterException
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.lifecycle import LifecycleNode, LifecycleState, TransitionCallbackReturn
from rclpy.logging import get_logger

from ..errors import UNUSABLE_INPUT, HdMonitorError

SUCCESS = TransitionCallbackReturn.SUCCESS


def logged[N: LifecycleNode](
    transition: Callable[[N, LifecycleState], TransitionCallbackReturn],
) -> Callable[[N, LifecycleState], TransitionCallbackReturn]:
    """Log an exception of a transition: the state machine of rclpy swallows it."""

    @wraps(transition)
    def logging(node: N, state: LifecycleState) -> TransitionCallbackReturn:
        try:
            return transition(node, state)
        except Exception:
            node.get_logger().error(traceback.format_exc())
            raise

    return logging


class ManagedNode(LifecycleNode):
    """A lifecycle node that needs no lifecycle manager; subclasses build in transitions and undo in two hooks.

    Parameters
    ----------
    name : str
    **options
        Passed on to the base class: ``context``, ``namespace``, ``parameter_overrides`` …

    Attributes
    ----------
    finished : bool
        Set by the node in one of its callbacks once its work is done; :func:`run` then ends.
    """

    def __init__(self, name: str, **options: Any) -> None:
        super().__init__(name, automatically_declare_parameters_from_overrides=True, **options)
        self.finished = False
        self._steady = Clock(clock_type=ClockType.STEADY_TIME)
        self._refusal: HdMonitorError | None = None

    def bring_up(self) -> None:
        """Configure and activate.

        Raises
        ------
        HdMonitorError
            The one that :meth:`refuse` was given, where a transition failed.
        """
        if self.trigger_configure() != SUCCESS or self.trigger_activate() != SUCCESS:
            raise self._refusal or HdMonitorError("the node could not be started; see the log above")

    def refuse(self, error: HdMonitorError) -> TransitionCallbackReturn:
        """Log why a transition is impossible and return its failure."""
        self._refusal = error
        self.get_logger().error(str(error))
        return TransitionCallbackReturn.FAILURE

    def stop_work(self) -> None:
        """Undo what activating built; called in any state, possibly twice."""
        raise NotImplementedError

    def dismantle(self) -> None:
        """Undo what configuring built; called in any state, possibly twice."""
        raise NotImplementedError

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Stop; what was configured stays."""
        self.stop_work()
        return super().on_deactivate(state)

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Drop what was configured."""
        self.dismantle()
        return super().on_cleanup(state)

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Stop and drop what was configured."""
        self.stop_work()
        self.dismantle()
        return super().on_shutdown(state)

    def on_error(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Fall back to unconfigured after an error in a transition."""
        self.get_logger().error(f"the transition from {state.label!r} failed: unconfigured now; see the log above")
        return self.on_shutdown(state)


def run(name: str, make: Callable[[], ManagedNode], args: list[str] | None = None) -> int:
    """Run a node until it has finished or is interrupted.

    Parameters
    ----------
    name : str
        Of the node, for messages from before it exists.
    make : callable
        Creates it, once ROS is initialised.
    args : list of str, optional
        Command line; `sys.argv` if None.

    Returns
    -------
    int
        Exit status: 0, or `UNUSABLE_INPUT` for parameters with which the node cannot work.
    """
    node = None
    try:
        rclpy.init(args=args)
    except RuntimeError as error:  # a parameter file that cannot be read, or a malformed argument
        get_logger(name).fatal(str(error))
        return UNUSABLE_INPUT
    try:
        node = make()
        executor = SingleThreadedExecutor()
        executor.add_node(node)
        # Not spin_until_future_complete, which adds a callback to its future in every turn and so grows without bound.
        while rclpy.ok() and not node.finished:
            executor.spin_once()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    except (HdMonitorError, ParameterException) as error:
        get_logger(name).fatal(str(error))
        return UNUSABLE_INPUT
    finally:
        # launch sends a second SIGINT, which must not interrupt the clean-up.
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        if node is not None:
            node.destroy_node()
        rclpy.try_shutdown()
    return 0
