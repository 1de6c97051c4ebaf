"""All joints in the terminal: what ``hd-monitor watch`` shows.

    source (DDS or a bag)  →  View: what is known of each joint  →  answers, panels: lines of text  →  app: the screen

A **source** turns a topic's bytes, or the assessments of a replay, into the next `View`, a frozen value. **Answers**
are the sentences: which joint, which part, how bad, how sure, what to do, since when. **Panels** lay them out for a
width, as lines of spans that name a role (``error``) and no colour. `app` alone knows the terminal's library, `live`
alone knows ROS, and nothing on the way from a topic to the screen imports the estimator.
"""
